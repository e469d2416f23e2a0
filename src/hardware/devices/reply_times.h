#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace microinjection {

/// Measures the reply time of a device at the start of a session. It includes the serial adapter,
/// whose latency timer may delay each reply by 16 ms.
class ReplyTimes {
 public:
  void clear() { times_.clear(); }
  /// s, from the last byte of a command to the first byte of its reply.
  void add(double time) { times_.push_back(std::max(0.0, time)); }
  /// The time (s) within which nine of ten replies came, so that one delay of the machine does not
  /// count. Empty if there are too few replies.
  std::optional<double> measured() const {
    if (times_.size() < kEnough) return std::nullopt;
    std::vector<double> sorted = times_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[(sorted.size() - 1) * 9 / 10];
  }

 private:
  static constexpr std::size_t kEnough = 8;
  std::vector<double> times_;  // s
};

}  // namespace microinjection
