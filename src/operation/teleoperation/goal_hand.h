#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct GoalHandConfig {
  double speed = 0.02;  ///< m/s, of the hand at the most
  double lead = 5e-3;   ///< m that steps may be ahead of the hand: it stops soon after the last one
  double present_timeout =
      0.75;  ///< s after the last sign of the operator; a keyboard repeats a key after 0.2 to 0.6 s

  /// Keys hand_speed and present_timeout.
  static GoalHandConfig read(ConfigReader& reader);
};

/// A hand for inputs that have none: keys that ask for steps, a mouse that drags to a place. It goes to its goal at a
/// limited speed. The operator is present from each sign of theirs until `present_timeout` later; without an operator
/// the hand rests where it is and its goal is forgotten.
class GoalHand {
 public:
  explicit GoalHand(const GoalHandConfig& config) : config_(config), time_since_input_(config.present_timeout) {}

  /// A step (m) from the goal; cut to `lead` ahead of the hand. A sign of the operator.
  void moveBy(const Eigen::Vector3d& step);
  /// To a place (m), of an operator who is present.
  void moveTo(const Eigen::Vector3d& goal);
  /// The operator is still there.
  void stay() { time_since_input_ = 0; }
  /// The operator is gone.
  void release();

  /// Advances by dt (s); returns the hand's position (m).
  const Eigen::Vector3d& step(double dt);

  const Eigen::Vector3d& position() const { return position_; }  ///< m
  bool present() const { return time_since_input_ < config_.present_timeout; }

 private:
  GoalHandConfig config_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();      ///< m
  double time_since_input_;                             ///< s since the operator's last sign
};

}  // namespace microinjection
