#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/Joy.h>

#include <optional>
#include <string>

#include "cell_microinjection/LoopState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/hand_motion.h"
#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {

/// A virtual haptic device and hand. The hand rests until the needle follows it, then follows a recorded
/// motion and yields to the force.
///
/// In:  /haptic/servo_cf (WrenchStamped, N; none while it is stale), /haptic/loop_state (LoopState: the motion
///      begins with the first one that says that the needle follows)
/// Out: /haptic/measured_cp (PoseStamped, m, frame `haptic`), /haptic/clutch (Joy, on change),
///      /virtual_hand/phase (StringStamped, latched, on change: the motion's phases, then done),
///      /controller/state_command (StringStamped: inject, when the phase of that name begins)
///
/// Parameters: config/virtual_hand.yaml
class VirtualHandNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit VirtualHandNode(Bus& bus);

 private:
  struct Parameters {
    std::string motion;
    double start_delay = 1;
    bool wait_for_go = false;
    double rate = 1000;
    double force_timeout = 0.05;
    std::string recorder;  ///< name of the node that must listen before the motion begins; empty: none
    VirtualHandConfig hand;
    static Parameters read(const Bus& bus);
  };

  bool mayMove();
  bool isHeard();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void step(const Cycle::Tick& tick);
  void publishClutch(const ros::Time& now, bool pressed);
  void publishPhase(const ros::Time& now, const std::string& phase);

  Parameters parameters_;
  HandMotion motion_;
  VirtualHand hand_;
  Cycle cycle_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Output<geometry_msgs::PoseStamped>& position_;
  Output<sensor_msgs::Joy>& clutch_;
  Output<cell_microinjection::StringStamped>& phase_;
  Output<cell_microinjection::StringStamped>& command_output_;
  bool go_;                ///< moves, and does not wait for the parameter /session/go
  ros::SteadyTime asked_;  ///< for it
  bool followed_ = false;  ///< the needle has followed the hand
  bool heard_ = false;     ///< by the recorder
  std::string hold_reason_ = "nothing came on /haptic/loop_state";
  double elapsed_ = 0;  ///< s of steps since then; a stall of the machine pauses the hand
  std::optional<bool> clutch_published_;
  std::string phase_published_;
  Subscription loop_;
};

}  // namespace microinjection
