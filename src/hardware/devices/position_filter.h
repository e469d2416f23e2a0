#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Accepts a position if it is near the expected one, or if four successive readings agree. So a
/// reply damaged on the line moves nothing. Four are needed, because a digit lost three times makes
/// the same wrong number.
class PositionFilter {
 public:
  /// Returns whether `reading` is accepted. `tolerance`: largest difference of any coordinate from
  /// `expected`. `agreement`: largest difference from the previous doubtful reading. All in one
  /// unit. Without expectation: NaN.
  bool accept(const Eigen::VectorXd& reading, const Eigen::VectorXd& expected, double tolerance, double agreement) {
    if (!reading.allFinite()) return false;
    const auto near = [&](const Eigen::VectorXd& position, double distance) {
      return ((reading - position).array().abs() <= distance).all();
    };
    const bool agrees = doubtful_ > 0 && near(last_, agreement);
    doubtful_ = near(expected, tolerance) ? 0 : agrees ? doubtful_ + 1 : 1;
    if (doubtful_ == kAgreeing) doubtful_ = 0;
    last_ = reading;
    return doubtful_ == 0;
  }
  bool isImplausible() const { return doubtful_ > 0; }
  /// More than one reading in a row: hardly a reply that was damaged.
  bool isContradicted() const { return doubtful_ > 1; }
  void clear() { doubtful_ = 0; }

 private:
  static constexpr int kAgreeing = 4;
  Eigen::VectorXd last_;
  int doubtful_ = 0;  // successive readings that agree with each other but not with the expected one
};

}  // namespace microinjection
