#pragma once

#include <geometry_msgs/PoseStamped.h>

#include "cell_microinjection/LinkPacket.h"
#include "nodes/haptic/peer_inputs.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/loop_state.h"
#include "operation/link/link_follower.h"

namespace microinjection {

/// The rig's end of a network between haptic bridge and rig. It publishes the needle's target from
/// the hand's packets and sends the tip's force back. Without packets, needle, force or controller
/// it withdraws its target, so that the controller holds the needle, and reports this to the hand's
/// side.
///
/// In:  /link/rig/received (LinkPacket) and those of PeerInputs
/// Out: /link/rig/sent (LinkPacket), /link/rig/loop_state (LoopState), /teleop/servo_cp
///      (PoseStamped, tip in `world`)
///
/// Parameters: config/link.yaml; the bridge must have the same `link`.
class TeleoperationFollowerNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit TeleoperationFollowerNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 1000;
    PeerTimeouts timeouts;
    ForceSourceConfig force;
    bool quiet_sensor = false;
    LinkConfig link;
    static Parameters read(const Bus& bus);
  };

  void step(const Cycle::Tick& tick);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  Parameters parameters_;
  LinkFollower model_;
  Cycle cycle_;
  PeerInputs rig_;
  Output<cell_microinjection::LinkPacket>& sent_;
  Output<geometry_msgs::PoseStamped>& target_;
  LoopStatePublisher loop_state_;
};

}  // namespace microinjection
