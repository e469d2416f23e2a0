#pragma once

#include "cell_microinjection/LinkPacket.h"
#include "nodes/haptic/teleop_peer.h"
#include "operation/link/link_leader.h"

namespace microinjection {

/// A rig behind a network: packets from and to teleoperation_follower carry needle, force and
/// target.
///
/// In:  /link/hand/received (LinkPacket)
/// Out: /link/hand/sent (LinkPacket)
class RemotePeer : public TeleopPeer {
 public:
  RemotePeer(Cycle& cycle, const LinkConfig& link, const HapticBridgeConfig& bridge);

  void read(HapticBridge::Input& input, const Cycle::Tick& tick) override;
  void send(const std::optional<Eigen::Vector3d>& target, const ros::Time& measured, const Cycle::Tick& tick) override;
  /// Packets that stop have the same effect.
  void withdraw(const ros::Time&) override {}
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const override;

 private:
  LinkLeader model_;
  double force_gain_;
  Output<cell_microinjection::LinkPacket>& sent_;
};

}  // namespace microinjection
