#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct FocusAxisConfig {
  Eigen::Vector2d range{-200e-6, 200e-6};  ///< m, lowest and highest position
  double speed = 100e-6;                   ///< m/s
  double start = 0;                        ///< m

  static FocusAxisConfig read(ConfigReader& reader);
};

/// The motor of the microscope's focus, as the commands see it: it moves with one speed to the last
/// goal, and stops there. Its position is the world's y of the plane in focus, m.
class FocusAxis {
 public:
  explicit FocusAxis(const FocusAxisConfig& config) : config_(config), position_(config.start), goal_(config.start) {}

  bool allows(double goal) const { return goal >= config_.range.x() && goal <= config_.range.y(); }
  /// @pre allows(goal)
  void moveTo(double goal) { goal_ = goal; }
  void step(double duration);  ///< s, not negative

  double position() const { return position_; }
  bool moving() const { return position_ != goal_; }
  const FocusAxisConfig& config() const { return config_; }

 private:
  FocusAxisConfig config_;
  double position_, goal_;  ///< m
};

}  // namespace microinjection
