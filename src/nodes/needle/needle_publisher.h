#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/JointState.h>

#include "cell_microinjection/ManipulatorAbilities.h"
#include "cell_microinjection/OperatingState.h"
#include "hardware/manipulator/micromanipulator.h"
#include "nodes/needle/manipulator_setup.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// Publishes the needle's state and its rig's abilities on the topics of
/// nodes/micromanipulator_node.h.
class NeedlePublisher {
 public:
  /// All references outlive this. @param joint_states_rate  Hz
  NeedlePublisher(Cycle& cycle, const ManipulatorGeometry& geometry, const ManipulatorSetup& rig,
                  const Micromanipulator& model, double joint_states_rate);

  /// Call after the model's step.
  void publish(const ros::Time& now);
  /// Publishes the state on change and as the reply to a command. Returns whether the operating
  /// state has changed.
  bool publishState(cell_microinjection::OperatingState state, const ros::Time& now, bool reply);
  void publishAbilities(const ros::Time& now);
  const cell_microinjection::OperatingState& lastPublishedState() const { return last_published_state_; }

 private:
  void publishMotion(const ros::Time& now);
  void publishJointStates(const ros::Time& now);

  const ManipulatorGeometry& geometry_;
  const ManipulatorSetup& rig_;
  const Micromanipulator& model_;
  double joint_states_period_;  ///< s
  Output<geometry_msgs::PoseStamped>& measured_;
  Output<geometry_msgs::PoseStamped>& setpoint_;
  Output<geometry_msgs::TwistStamped>& velocity_;
  Output<geometry_msgs::PoseStamped>* true_ = nullptr;  ///< null when the true pose is unknown
  Publisher<sensor_msgs::JointState> joint_states_;
  Publisher<cell_microinjection::OperatingState> state_;
  Publisher<cell_microinjection::ManipulatorAbilities> abilities_;
  cell_microinjection::OperatingState last_published_state_;
  cell_microinjection::ManipulatorAbilities last_published_abilities_;
  ros::Time joint_states_sent_;
};

}  // namespace microinjection
