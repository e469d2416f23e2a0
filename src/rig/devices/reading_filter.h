#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Takes a position for true when it is where it may be, or when four readings in a row say the same: a reply that was
/// damaged on the line moves nothing. Fewer would not do: a digit that is lost thrice makes the same wrong number.
class ReadingFilter {
 public:
  /// Whether `reading` is taken. `tolerance`: the largest difference of any coordinate from `expected`, `agreement`:
  /// from the doubtful reading before (all in one unit). No expectation: NaN.
  bool accept(const Eigen::VectorXd& reading, const Eigen::VectorXd& expected, double tolerance, double agreement) {
    if (!reading.allFinite()) return false;
    const auto near = [&](const Eigen::VectorXd& place, double distance) {
      return ((reading - place).array().abs() <= distance).all();
    };
    const bool agrees = doubtful_ > 0 && near(last_, agreement);
    doubtful_ = near(expected, tolerance) ? 0 : agrees ? doubtful_ + 1 : 1;
    if (doubtful_ == kAgreeing) doubtful_ = 0;
    last_ = reading;
    return doubtful_ == 0;
  }
  bool isImplausible() const { return doubtful_ > 0; }
  void clear() { doubtful_ = 0; }

 private:
  static constexpr int kAgreeing = 4;
  Eigen::VectorXd last_;
  int doubtful_ = 0;  // readings in a row that agree with each other and not with what was expected
};

}  // namespace microinjection
