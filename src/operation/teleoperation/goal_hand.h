#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct GoalHandConfig {
  double speed = 0.02;  ///< m/s, largest speed of the hand
  double lead = 5e-3;   ///< m, largest distance of the goal: the hand stops soon after the last step
  double present_timeout =
      0.75;  ///< s without input until the operator counts as absent; a keyboard repeats a key after 0.2 to 0.6 s

  /// Keys hand_speed and present_timeout.
  static GoalHandConfig read(ConfigReader& reader);
};

/// A simulated hand for inputs without one: keys that request steps, a mouse that drags to a
/// position. It moves to its goal at a limited speed. After each input the operator counts as
/// present for `present_timeout`. Without an operator the hand rests and its goal is cleared.
class GoalHand {
 public:
  explicit GoalHand(const GoalHandConfig& config) : config_(config), time_since_input_(config.present_timeout) {}

  /// Moves the goal by a step (m), at most to `lead` ahead of the hand. Counts as input of the
  /// operator.
  void moveBy(const Eigen::Vector3d& step);
  /// Sets the goal (m). Does not count as input: call stay(), too.
  void moveTo(const Eigen::Vector3d& goal);
  /// Counts as input of the operator.
  void stay() { time_since_input_ = 0; }
  /// Ends the operator's presence and clears the goal.
  void release();

  /// Advances by dt (s); returns the hand's position (m).
  const Eigen::Vector3d& step(double dt);

  const Eigen::Vector3d& position() const { return position_; }  ///< m
  bool present() const { return time_since_input_ < config_.present_timeout; }

 private:
  GoalHandConfig config_;
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();      ///< m
  double time_since_input_;                             ///< s since the operator's last input
};

}  // namespace microinjection
