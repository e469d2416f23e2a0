#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

namespace microinjection {

/// One measured thing in one image.
struct VisionRow {
  std::string set, image, what;
  double error = std::numeric_limits<double>::quiet_NaN();      ///< px; planes of focus, degrees of an axis
  double relative = std::numeric_limits<double>::quiet_NaN();   ///< of the truth
  double deviation = std::numeric_limits<double>::quiet_NaN();  ///< stated standard deviation, unit of the error
  bool found = false;                                           ///< it has values
  bool sure = false;                                            ///< without a warning
  bool wrong = false;                                           ///< sure, and not so
  std::optional<bool> right{};    ///< sure, and within the limit; none: no limit holds for it
  std::optional<bool> covered{};  ///< the truth is in the stated interval of 95 %; none: none was stated
  std::string verdict{};          ///< empty: a time alone
  std::string reason{};           ///< of a verdict that is not found
  double time = std::numeric_limits<double>::quiet_NaN();  ///< s of processor time
  std::string group{};  ///< of a real image's row: readable, far (there, and need not be found), absent, unread
};

/// An error above this many times the goal is wrong in a rendered image, not merely inexact.
constexpr double kWrongFactor = 10;

using TakeRow = std::function<void(const VisionRow&)>;

}  // namespace microinjection
