#pragma once

#include <ros/ros.h>

#include <string>

#include "nodes/needle/needle_commands.h"
#include "nodes/needle/needle_publisher.h"
#include "nodes/needle/rig_device.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// A micromanipulator, simulated, emulated or real, behind the same topics, with CRTK's operating states. A refused
/// command leaves the needle where it was; the reason is in the log and on the diagnostics, and so is a move that
/// another command ends. A second node that commands the needle beside the first is a FAULT until `enable`
/// (rig/manipulator/command_authority.h).
///
/// In:  /needle/servo_cp (PoseStamped), /needle/servo_cv (TwistStamped), /needle/move_cp (PoseStamped), in `world`; old
///      ones are refused. Without a stamp they count from their arrival, and are refused when their publisher latches;
///      /needle/state_command (StringStamped: enable, disable, pause, resume, home, unhome, as base/operating_state.h
///      has them, and stop, which keeps the state). home moves nothing: the driver finds the axes' reference positions;
///      /needle/emulated_fault (StringStamped, see rig/serial/fault.h), of a simulated or emulated device
/// Out: /needle/measured_cp (PoseStamped), /needle/measured_cv (TwistStamped), both at the tip in `world`, stamp 0
///      while the device does not know; /needle/setpoint_cp (PoseStamped), where the device is sent, stamp 0 while it
///      follows a velocity; /needle/true_cp (PoseStamped), where the tip truly is: of the simulated device only;
///      /needle/abilities (ManipulatorAbilities; on change and once a second), /needle/operating_state (OperatingState:
///      DISABLED without connection, FAULT until enable or disable; is_busy of moves only, once true and once false for
///      each; on change, and in answer to each state_command); /needle/setpoint_trace (TimeReference); joint_states
///      (JointState), for robot_state_publisher
///
/// Parameters: /robot_description (URDF), and private those of MicromanipulatorConfig and
///   rig                sim (default), or a name of rig/devices/rig_registry.h
///   emulated           default false; true: the driver talks to an emulated device in this process
///   device/            the rig's own, as in config/rigs/NAME.yaml
///   emulator/          of an emulated one: latency (s, of its serial adapter), and what its emulator reads
///   rate               Hz; default 1000, in [50, 5000]
///   joint_states_rate  Hz; default 50, in (0, 1000]
///   allow_network      default false: a real rig is not enabled while others on a network can reach this machine
class MicromanipulatorNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError
  MicromanipulatorNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    double rate = 1000;
    double joint_states_rate = 50;
    std::string rig = "sim";
    bool emulated = false;
    bool allow_network = false;
    MicromanipulatorConfig model;
    static Parameters read(ConfigReader& reader);
  };

  explicit MicromanipulatorNode(const ros::NodeHandle& node, ConfigReader reader);
  void step(const Cycle::Tick& tick);
  void publishState(const Cycle::Tick& tick);

  Parameters parameters_;
  ManipulatorGeometry geometry_;
  RigDevice rig_;
  Micromanipulator model_;
  Cycle cycle_;
  NeedleCommands commands_;
  NeedlePublisher publisher_;
};

}  // namespace microinjection
