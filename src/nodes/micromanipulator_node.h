#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/TimeReference.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "manipulator/command_authority.h"
#include "manipulator/micromanipulator.h"
#include "nodes/cycle.h"
#include "nodes/network_watch.h"
#include "nodes/rig_device.h"

namespace microinjection {

/// A micromanipulator, simulated, emulated or real, behind the same topics. A refused command leaves the needle where
/// it was; the reason is logged and shown on the diagnostics. A second node that commands the needle beside the first
/// is a FAULT until `enable` (manipulator/command_authority.h).
///
/// In:  /needle/servo_cp (PoseStamped), /needle/servo_cv (TwistStamped), /needle/move_cp (PoseStamped), in `world`; old
/// ones are refused;
///      /needle/state_command (StringStamped: enable, disable, stop);
///      /needle/emulated_fault (StringStamped, see serial/fault.h), of a simulated or emulated device
/// Out: /needle/measured_cp (PoseStamped), /needle/measured_cv (TwistStamped), both at the tip in `world`, stamp 0
/// while
///      the device does not know; /needle/true_cp (PoseStamped), where the tip truly is: of the simulated device only;
///      /needle/abilities (ManipulatorAbilities; on change and once a second), /needle/operating_state (OperatingState:
///      DISABLED without connection, FAULT until enable; on change, and in answer to each state_command);
///      /needle/setpoint_trace (TimeReference); joint_states (JointState), for robot_state_publisher
///
/// Parameters: /robot_description (URDF), and private those of MicromanipulatorConfig and
///   rig                sim (default), or a name of rigs/rig_registry.h
///   emulated           default false; true: the driver talks to an emulated device in this process
///   device/            the rig's own, as in src/rigs/NAME/NAME.yaml
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
  void subscribe();
  void step(const Cycle::Tick& tick);
  void obeyServo(const Cycle::Tick& tick);
  void onVelocity(const geometry_msgs::TwistStamped& message, const std::string& sender);
  void onMove(const geometry_msgs::PoseStamped& message, const std::string& sender);
  std::string obeyState(const cell_microinjection::StringStamped& message);
  /// As the device has it: a clock that is set back does not take it along.
  double time() const { return now_.toSec() + set_back_; }
  double age(
      const std_msgs::Header& header) const {  ///< s; as of now, not of the last step: this node may have been frozen
    return secondsBetween(header.stamp, std::max(now_, ros::Time::now()));
  }
  std::string unable() const;  ///< why motion commands are refused here; else empty
  /// Notes who commands; a second source stops the needle.
  void authorize(const std::string& sender);
  void lookAtNetwork();
  bool moves() const;
  void judge(const std::string& command, const std::string& refusal);
  void publish(const Cycle::Tick& tick);
  void publishJointStates(const ros::Time& now);
  void publishState(const ros::Time& now);
  void publishAbilities(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  ManipulatorGeometry geometry_;
  RigDevice rig_;
  Micromanipulator model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& servo_;
  Output<geometry_msgs::PoseStamped>& measured_;
  Output<geometry_msgs::PoseStamped>* true_ = nullptr;  ///< null where the truth is not known
  Output<geometry_msgs::TwistStamped>& velocity_;
  Output<sensor_msgs::TimeReference>& trace_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Publisher joint_states_;
  ros::Publisher state_;
  ros::Publisher abilities_;
  cell_microinjection::OperatingState said_;
  cell_microinjection::ManipulatorAbilities told_;
  CommandAuthority authority_;
  std::unique_ptr<NetworkWatch> network_;  ///< null where it does not matter who can reach this machine
  bool exposed_ = false;                   ///< a real rig, and others can reach this machine
  bool admitted_ = false;                  ///< enabled while nobody else could reach this machine
  bool disabled_ = false;                  ///< by command
  bool master_lost_ = false;
  bool answer_ = false;  ///< a state command was heard
  ros::Time joint_states_sent_;
  ros::Time now_;
  double set_back_ = 0;  ///< s, that the clock was
  unsigned refused_ = 0;
  std::string refusal_;  ///< of the last command; empty when it was obeyed
};

}  // namespace microinjection
