#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/TimeReference.h>

#include <string>

#include "nodes/haptic/peer_inputs.h"
#include "nodes/haptic/teleop_peer.h"

namespace microinjection {

/// A rig whose nodes run in the bridge's session.
///
/// In:  those of PeerInputs
/// Out: /teleop/servo_cp (PoseStamped, tip in `world`); `trace`: see nodes/runtime/latency_meter.h
class LocalPeer : public TeleopPeer {
 public:
  LocalPeer(Cycle& cycle, const PeerTimeouts& timeouts, const ForceSourceConfig& source, bool quiet_sensor,
            Output<sensor_msgs::TimeReference>& trace);

  void read(HapticBridge::Input& input, const Cycle::Tick& tick) override;
  void send(const std::optional<Eigen::Vector3d>& target, const ros::Time& measured, const Cycle::Tick& tick) override;
  void withdraw(const ros::Time& now) override;
  std::string holdReason() const override { return controller_ ? "" : "the controller is silent"; }

 private:
  PeerInputs inputs_;
  Output<geometry_msgs::PoseStamped>& target_;
  Output<sensor_msgs::TimeReference>& trace_;
  bool controller_ = true;  ///< in the last step
};

}  // namespace microinjection
