#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <string>

#include "cell_microinjection/LatencyTrace.h"
#include "manipulator/micromanipulator.h"
#include "manipulator/simulated_manipulator.h"
#include "nodes/cycle.h"

namespace microinjection {

/// The simulated micromanipulator behind the topics of a real one. A refused command leaves the needle where it was;
/// the reason is logged and shown on the diagnostics.
///
/// In:  /needle/servo_cp (PoseStamped), /needle/servo_cv (TwistStamped), /needle/move_cp (PoseStamped), in `world`
/// Out: /needle/measured_cp (PoseStamped), /needle/measured_cv (TwistStamped), both at the tip in `world`;
///      /needle/setpoint_trace (LatencyTrace); joint_states (JointState) for robot_state_publisher
///
/// Parameters: /robot_description (URDF), and private those of MicromanipulatorConfig and
///   rate               Hz; default 1000, in [50, 5000]
///   joint_states_rate  Hz; default 50, in (0, 1000]
///   simulated/         those of SimulatedManipulatorConfig
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
    MicromanipulatorConfig model;
    SimulatedManipulatorConfig device;
    static Parameters read(const ros::NodeHandle& private_node);
  };

  void step(const Cycle::Tick& tick);
  void obeyServo(const Cycle::Tick& tick);
  void judge(const std::string& command, const std::string& refusal);
  void publish(const Cycle::Tick& tick);
  void publishJointStates(const ros::Time& now);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  ManipulatorGeometry geometry_;
  SimulatedManipulator device_;
  Micromanipulator model_;
  Cycle cycle_;
  Input<geometry_msgs::PoseStamped>& servo_;
  Output<geometry_msgs::PoseStamped>& measured_;
  Output<geometry_msgs::TwistStamped>& velocity_;
  Output<cell_microinjection::LatencyTrace>& trace_;
  ros::Subscriber servo_velocity_;
  ros::Subscriber move_;
  ros::Publisher joint_states_;
  ros::Time joint_states_sent_;
  ros::Time now_;
  unsigned refused_ = 0;
  std::string refusal_;  ///< of the last command; empty when it was obeyed
};

}  // namespace microinjection
