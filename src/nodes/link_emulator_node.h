#pragma once

#include <std_msgs/Bool.h>

#include "cell_microinjection/LinkPacket.h"
#include "nodes/runtime/cycle.h"
#include "operation/link/link_emulator.h"

namespace microinjection {

/// A network between haptic bridge and teleoperation_follower that delays, reorders and loses
/// packets.
///
/// In:  /link/hand/sent, /link/rig/sent (LinkPacket), /link/plugged (Bool; false: a cable is
///      disconnected)
/// Out: /link/rig/received, /link/hand/received (LinkPacket)
///
/// Parameters: see kHelp
class LinkEmulatorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit LinkEmulatorNode(Bus& bus);

 private:
  using Message = cell_microinjection::LinkPacket;

  void step(const Cycle::Tick& tick);

  LinkConditions conditions_;
  Cycle cycle_;
  LinkEmulator<Message> to_rig_, to_hand_;
  Subscription plug_;
  bool plugged_ = true;
  Output<Message>&rig_received_, &hand_received_;
};

}  // namespace microinjection
