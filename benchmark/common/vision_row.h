#pragma once

#include <functional>
#include <limits>
#include <string>

namespace microinjection {

/// One measured thing in one image.
struct VisionRow {
  std::string set, image, what;
  double error = std::numeric_limits<double>::quiet_NaN();     ///< px; planes of focus, degrees of an axis
  double relative = std::numeric_limits<double>::quiet_NaN();  ///< of the truth
  bool found = false;                                          ///< it has values
  bool sure = false;                                           ///< without a warning
  bool wrong = false;                                          ///< sure, and not so
  std::string verdict{};
  double time = std::numeric_limits<double>::quiet_NaN();  ///< s of processor time
};

/// An error above this many times the goal is wrong, not merely inexact.
constexpr double kWrongFactor = 10;

using TakeRow = std::function<void(const VisionRow&)>;

/// Rows of the real micrographs, nothing without their folder. real_tune and real_held are every second
/// file of each source in the order of its readings. Both were looked at while the constants were
/// chosen, so neither is independent: only images that nobody here has seen are.
void realRows(const TakeRow& take);

}  // namespace microinjection
