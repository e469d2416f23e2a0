#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace microinjection {

/// How long a device takes to answer, measured at the begin of a session: with what the serial adapter adds, whose
/// latency timer may hold back each answer for 16 ms.
class AnswerTimes {
 public:
  void clear() { times_.clear(); }
  /// s, from the last byte of a command to the first of its answer.
  void add(double time) { times_.push_back(std::max(0.0, time)); }
  /// Within which nine of ten answers came (s), so that a machine that was held up once does not count. Empty: too few
  /// answers were heard.
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
