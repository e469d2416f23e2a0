#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/needle/rig_device.h"
#include "nodes/runtime/cycle.h"
#include "rig/manipulator/micromanipulator.h"

namespace microinjection {

/// Says what the needle does and what its rig can: the topics that nodes/micromanipulator_node.h names.
class NeedlePublisher {
 public:
  /// All outlive this. @param joint_states_rate  Hz
  NeedlePublisher(Cycle& cycle, const ManipulatorGeometry& geometry, const RigDevice& rig,
                  const Micromanipulator& model, double joint_states_rate);

  /// After the model's step.
  void publish(const ros::Time& now);
  /// On change, or where a command is to be answered. Whether the state is another than before.
  bool publishState(cell_microinjection::OperatingState state, const ros::Time& now, bool answer);
  void publishAbilities(const ros::Time& now);
  const cell_microinjection::OperatingState& said() const { return said_; }  ///< the last that was published

 private:
  void publishMotion(const ros::Time& now);
  void publishJointStates(const ros::Time& now);

  const ManipulatorGeometry& geometry_;
  const RigDevice& rig_;
  const Micromanipulator& model_;
  double joint_states_period_;  ///< s
  Output<geometry_msgs::PoseStamped>& measured_;
  Output<geometry_msgs::PoseStamped>& setpoint_;
  Output<geometry_msgs::TwistStamped>& velocity_;
  Output<geometry_msgs::PoseStamped>* true_ = nullptr;  ///< null where the truth is not known
  ros::Publisher joint_states_;
  ros::Publisher state_;
  ros::Publisher abilities_;
  cell_microinjection::OperatingState said_;
  cell_microinjection::ManipulatorAbilities told_;
  ros::Time joint_states_sent_;
};

}  // namespace microinjection
