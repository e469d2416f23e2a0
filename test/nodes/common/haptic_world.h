#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

/// The node haptic_device with a file of config/haptic. The test is the bridge, and the driver of the device: a node
/// of its own, since a device counts only while the node that tells its position takes its force.
class HapticWorld {
 public:
  /// `overrides`: of the session, such as "hand.device:=omni".
  explicit HapticWorld(const std::vector<std::string>& overrides)
      : session_(overrides), driver_(session_.addTestNode("driver")) {
    TestNode& world = session_.world();
    world.hear<geometry_msgs::PoseStamped>("haptic/measured_cp");
    world.hear<sensor_msgs::Joy>("haptic/clutch");
    world.hear<sensor_msgs::Joy>("haptic/operator_present");
    world.hear<cell_microinjection::StringStamped>("controller/state_command");
    session_.add("haptic_device", "{diagnostic_period: 0.1}");
  }

  TestNode& driver() { return driver_; }
  TestNode& world() { return session_.world(); }
  void run(double seconds) { session_.run(seconds); }
  const HeardDiagnostics& diagnostics() const { return session_.diagnostics(); }

  /// The bridge's force (N), from now on.
  void force(double x, double y, double z) { world().repeat("haptic/servo_cf", wrenchMessage(x, y, z, "haptic")); }
  void silenceForce() { world().silence("haptic/servo_cf"); }

  /// The hand (m) that the bridge is told.
  Eigen::Vector3d hand() { return toVector(newestHand().pose.position); }
  const geometry_msgs::PoseStamped& newestHand() {
    return *world().hear<geometry_msgs::PoseStamped>("haptic/measured_cp").newest();
  }
  /// Whether the clutch is pressed and whether the operator is present, as the bridge is told.
  std::pair<int, int> buttons() { return {pressed("haptic/clutch"), pressed("haptic/operator_present")}; }
  /// Whether the bridge is told that there is no hand, and nobody at it.
  bool isSilent() { return newestHand().header.stamp.isZero() && buttons().second == 0; }
  /// What was sent to /controller/state_command.
  std::vector<std::string> commands() {
    std::vector<std::string> words;
    for (const auto& message : world().hear<cell_microinjection::StringStamped>("controller/state_command").all())
      words.push_back(message->string);
    return words;
  }

 private:
  int pressed(const std::string& topic) { return world().hear<sensor_msgs::Joy>(topic).newest()->buttons.at(0); }

  VirtualSession session_;
  TestNode& driver_;
};

}  // namespace microinjection
