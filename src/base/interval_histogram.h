#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace microinjection {

/// Distribution of durations in constant memory: bins 2 % wide, equal in the logarithm, from 0.1 us
/// to 100 s.
class IntervalHistogram {
 public:
  struct Bin {
    double upper = 0;  ///< s
    std::uint32_t count = 0;
  };

  /// @param limit  s; durations above it are counted exactly
  explicit IntervalHistogram(double limit = std::numeric_limits<double>::infinity()) : limit_(limit) {}

  /// Adds a duration (s). Durations outside the bins count in the first or last one. Does not
  /// allocate.
  void add(double duration);

  std::uint64_t count() const { return count_; }
  std::uint64_t countOverLimit() const { return over_limit_; }
  double largest() const { return largest_; }  ///< s; 0 when empty

  /// Duration (s) that the share `quantile` (0..1) of the samples does not exceed, within 1 %; 0
  /// when empty.
  double quantile(double quantile) const;

  /// The bins that are not empty, ascending.
  std::vector<Bin> bins() const;

 private:
  static constexpr double kSmallest = 1e-7;  ///< s
  static constexpr double kWidth = 0.02;     ///< of a bin, in the natural logarithm
  std::array<std::uint32_t, 1040> bins_{};
  std::uint64_t count_ = 0;
  std::uint64_t over_limit_ = 0;
  double limit_;  ///< s
  double largest_ = 0;
};

}  // namespace microinjection
