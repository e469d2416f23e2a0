#pragma once

#include <Eigen/Core>
#include <optional>

namespace microinjection {

/// Takes a position for true when it is where it may be, or when a second reading says the same: a byte that was
/// garbled on the line moves nothing.
class ReadingFilter {
 public:
  /// Whether `reading` is taken. `tolerance`: the largest difference from `expected`, or from the reading before that was
  /// not taken, of any coordinate (all in one unit). No expectation: NaN.
  bool accept(const Eigen::VectorXd& reading, const Eigen::VectorXd& expected, double tolerance) {
    if (!reading.allFinite()) return false;
    const auto near = [&](const Eigen::VectorXd& place) {
      return ((reading - place).array().abs() <= tolerance).all();
    };
    const bool taken = near(expected) || (doubtful_ && near(*doubtful_));
    doubtful_ = taken ? std::nullopt : std::optional<Eigen::VectorXd>(reading);
    return taken;
  }
  bool doubts() const { return doubtful_.has_value(); }
  void forget() { doubtful_.reset(); }

 private:
  std::optional<Eigen::VectorXd> doubtful_;
};

}  // namespace microinjection
