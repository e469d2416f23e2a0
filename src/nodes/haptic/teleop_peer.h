#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/haptic_bridge.h"

namespace microinjection {

/// The rig as the haptic bridge sees it: on this machine (LocalPeer) or behind a network
/// (RemotePeer).
class TeleopPeer {
 public:
  virtual ~TeleopPeer() = default;
  /// Sets needle and force of the input; leaves them empty if they are invalid.
  virtual void read(HapticBridge::Input& input, const Cycle::Tick& tick) = 0;
  /// Sends the target, or that there is none. `measured`: stamp of the hand's position.
  virtual void send(const std::optional<Eigen::Vector3d>& target, const ros::Time& measured,
                    const Cycle::Tick& tick) = 0;
  /// Withdraws the target outside of a step, before the node ends.
  virtual void withdraw(const ros::Time& now) = 0;
  /// Why the needle does not follow, if the bridge cannot know it; else empty.
  virtual std::string holdReason() const { return ""; }
  virtual void report(diagnostic_updater::DiagnosticStatusWrapper&) const {}
};

}  // namespace microinjection
