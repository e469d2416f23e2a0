#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

/// The needle of a session, which a test moves past the controller.
class ControlledNeedle {
 public:
  explicit ControlledNeedle(VirtualSession& session) : session_(session) {
    poses();
    states("/needle/operating_state");
    states("/controller/operating_state");
    session.world().publisher<geometry_msgs::PoseStamped>("/needle/move_cp");
  }

  Probe<geometry_msgs::PoseStamped>& poses() {
    return session_.world().hear<geometry_msgs::PoseStamped>("/needle/measured_cp");
  }
  /// m, by the rig
  Eigen::Vector3d place() {
    return poses().newest() ? toVector(poses().newest()->pose.position) : Eigen::Vector3d::Constant(NAN);
  }
  std::string controller() {
    const auto* state = states("/controller/operating_state").newest();
    return state ? state->state : "";
  }
  void expectController(const std::string& command, const std::string& state) {
    session_.world().command("/controller/state_command", command);
    EXPECT_TRUE(session_.until([&] { return controller() == state; }, 1)) << controller();
  }
  void enable() { expectController("enable", "ENABLED"); }
  void disable() { expectController("disable", "DISABLED"); }

  /// The controller is DISABLED afterwards: two must not command the needle.
  void moveTo(const Eigen::Vector3d& goal) {
    disable();
    session_.run(0.2);  // the controller's last set-point grows stale
    session_.world().sayNow("/needle/move_cp", poseMessage(goal.x(), goal.y(), goal.z()));
    const auto arrived = [&] {
      return (place() - goal).norm() < 1e-9 && !states("/needle/operating_state").newest()->is_busy;
    };
    EXPECT_TRUE(session_.until(arrived, 10)) << "the needle is at " << 1e6 * place().transpose() << " um";
  }
  /// m, of the poses since the last clear() of poses()
  double lowest() {
    double lowest = place().z();
    for (const auto& pose : poses().all()) lowest = std::min(lowest, pose->pose.position.z);
    return lowest;
  }
  /// That from `within` s from now on it stays where it is.
  void expectRests(double within) {
    session_.run(within);
    const Eigen::Vector3d rest = place();
    poses().clear();
    session_.run(0.5);
    double farthest = 0;
    for (const auto& pose : poses().all()) farthest = std::max(farthest, (toVector(pose->pose.position) - rest).norm());
    EXPECT_GT(poses().count(), 400u);
    EXPECT_LT(farthest, 1e-9);
  }

 private:
  Probe<cell_microinjection::OperatingState>& states(const std::string& topic) {
    return session_.world().hear<cell_microinjection::OperatingState>(topic);
  }

  VirtualSession& session_;
};

}  // namespace microinjection
