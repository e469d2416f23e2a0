#pragma once

#include <geometry_msgs/PoseStamped.h>

#include <optional>
#include <string>

#include "nodes/needle/manipulator_setup.h"
#include "nodes/needle/needle_commands.h"
#include "nodes/needle/needle_publisher.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/loop_state.h"

namespace microinjection {

/// A micromanipulator, simulated, emulated, real or of another node (needle/external_manipulator.h), with the same
/// topics and CRTK's operating states. A refused command does not move the needle. Log and diagnostics report the
/// reason, and each move that another command ends. When a second node commands the needle beside the first, the state
/// is FAULT until `enable` (hardware/manipulator/command_authority.h).
///
/// A session with a second manipulator runs this node twice: `holder_rig` moves the frame holding_pipette, with all
/// topics below /holder_rig in place of /needle, and begins DISABLED. Each of the two takes the links of the other one
/// for obstacles, where that one is by its measured_cp.
///
/// In:  /needle/servo_cp (PoseStamped), /needle/servo_cv (TwistStamped), /needle/move_cp
///      (PoseStamped), in `world`. Old ones are refused. Without a stamp the time of arrival
///      counts, and commands of latching publishers are refused.
///      /needle/state_command (StringStamped: enable, disable, pause, resume, home, unhome of
///      base/operating_state.h, and stop, which keeps the state). home moves nothing: the driver
///      finds the axes' reference positions.
///      /other_rig/measured_cp (PoseStamped), with parameter other/tip: remapped to the other manipulator's
///      /needle/emulated_fault (StringStamped, see hardware/serial/fault.h), of a simulated or emulated
///      device
/// Out: /needle/measured_cp (PoseStamped), /needle/measured_cv (TwistStamped): the tip in `world`,
///      stamp 0 while the device's position is invalid
///      /needle/setpoint_cp (PoseStamped): the device's set-point, stamp 0 during a velocity
///      /needle/true_cp (PoseStamped): true pose of the tip, of the simulated device only
///      /needle/abilities (ManipulatorAbilities; on change and once a second)
///      /needle/operating_state (OperatingState; on change and after each state_command): DISABLED
///      without connection, FAULT until enable or disable; is_busy only for moves, once true and
///      once false for each
///      /needle/loop_state (LoopState): whether a stream of commands moves the needle
///      /needle/setpoint_trace (TimeReference)
///      joint_states (JointState), for robot_state_publisher
///
/// Parameters: config/micromanipulator.yaml
class MicromanipulatorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  explicit MicromanipulatorNode(Bus& bus);

 private:
  struct Parameters {
    double rate = 1000;
    double joint_states_rate = 50;
    std::string rig = "sim";
    bool emulated = false;
    bool allow_network = false;
    bool auto_enable = true;
    std::string tip = "needle_tip";  ///< link of the URDF
    std::string other_tip;           ///< of a second manipulator; empty: there is none
    double other_tilt = 0;           ///< rad, of its pipette
    MicromanipulatorConfig model;
    static Parameters read(ConfigReader& reader);
  };

  MicromanipulatorNode(Bus& bus, ConfigReader reader);
  void step(const Cycle::Tick& tick);
  void publishState(const Cycle::Tick& tick);
  void followOther();
  void reportOther(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  ManipulatorGeometry geometry_;
  std::optional<ManipulatorGeometry> other_geometry_;
  Cycle cycle_;
  ManipulatorSetup rig_;
  Micromanipulator model_;
  NeedleCommands commands_;
  NeedlePublisher publisher_;
  LoopStatePublisher loop_state_;
  Input<geometry_msgs::PoseStamped>* other_ = nullptr;  ///< null without a second manipulator
};

}  // namespace microinjection
