#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cell_microinjection/InjectionStatus.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

constexpr char kHand[] = "haptic/measured_cp", kClutch[] = "haptic/clutch", kPresent[] = "haptic/operator_present";
constexpr char kNeedle[] = "needle/measured_cp", kPredicted[] = "cell/predicted_cf";
constexpr char kController[] = "controller/injection_state";

/// The node haptic_bridge alone. The test is the hand, the needle, the cell and the controller.
class BridgeWorld {
 public:
  /// `changes`: of the bridge's parameters, YAML; `overrides`: of the session.
  explicit BridgeWorld(const std::string& changes = "{}", const std::vector<std::string>& overrides = {})
      : session_(overrides) {
    world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf");
    world().hear<geometry_msgs::PoseStamped>("teleop/servo_cp");
    sayGood();
    session_.add("haptic_bridge", changes);
  }

  /// From now on valid positions, a force of 1 uN, and a controller that lives.
  void sayGood() {
    world().repeat(kHand, poseMessage(0, 0, 0, "haptic"));
    world().repeat(kNeedle, poseMessage(0, 0, 25e-6));
    world().repeat(kPredicted, wrenchMessage(0, 0, 1e-6));
    world().repeat(kController, cell_microinjection::InjectionStatus());
  }

  TestNode& world() { return session_.world(); }
  VirtualSession& session() { return session_; }
  void run(double seconds) { session_.run(seconds); }

  /// Whether it tells the controller a target.
  bool follows() {
    const auto* target = world().hear<geometry_msgs::PoseStamped>("teleop/servo_cp").newest();
    return target && !target->header.stamp.isZero();
  }
  /// N, on the hand.
  Eigen::Vector3d force() {
    const auto* message = world().hear<geometry_msgs::WrenchStamped>("haptic/servo_cf").newest();
    return message ? toVector(message->wrench.force) : Eigen::Vector3d::Constant(NAN);
  }

 private:
  VirtualSession session_;
};

}  // namespace microinjection
