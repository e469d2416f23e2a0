#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace microinjection {

/// The pulses received so far. A repeated message must not inject twice.
class PulseIds {
 public:
  /// Returns true if the id is new, and stores it among the last thousand.
  bool isNew(std::uint64_t id) {
    if (std::find(seen_.begin(), seen_.end(), id) != seen_.end()) return false;
    seen_.push_back(id);
    if (seen_.size() > kRemembered) seen_.pop_front();
    return true;
  }

 private:
  static constexpr std::size_t kRemembered = 1000;
  std::deque<std::uint64_t> seen_;
};

}  // namespace microinjection
