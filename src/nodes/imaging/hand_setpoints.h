#pragma once

#include <geometry_msgs/PoseStamped.h>

#include <Eigen/Core>
#include <string>

#include "nodes/imaging/tip_watch.h"

namespace microinjection {

/// The set-points of a goal that takes the hand's place: they go through the controller in mode manual,
/// whose limits and guards hold.
class HandSetpoints {
 public:
  /// `watch` outlives this.
  HandSetpoints(Bus& bus, const TipWatch& watch);

  /// The needle's position (m), from which a goal may begin. @throws ConfigError with the reason why none may
  Eigen::Vector3d requireStart() const;
  void begin(const Eigen::Vector3d& start);
  /// The controller then holds the needle.
  void end() { setpoints_.shutdown(); }

  /// Why the goal must end; empty: it may go on.
  std::string interruption() const;
  /// Publishes the start. Call it each step until the controller has engaged. @returns whether it has
  bool engage();
  void publish(const Eigen::Vector3d& setpoint) const;  ///< m

 private:
  Bus& bus_;
  const TipWatch& watch_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();   ///< m
  Eigen::Vector2i images_ = Eigen::Vector2i::Zero();  ///< px, their size when the goal began
  ros::SteadyTime begun_, connected_;                 ///< of the goal, and of the connection to the controller
  bool engaged_ = false;
  Publisher<geometry_msgs::PoseStamped> setpoints_;  ///< while a goal is active, so that a hand finds the topic free
  Subscription others_;                              ///< counts the publishers of the set-points
};

}  // namespace microinjection
