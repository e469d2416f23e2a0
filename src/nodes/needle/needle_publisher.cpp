#include "nodes/needle/needle_publisher.h"

#include <optional>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

constexpr double kAbilitiesPeriod = 1;  // s

void publishPose(Output<geometry_msgs::PoseStamped>& output, const std::optional<Eigen::Isometry3d>& pose,
                 const ros::Time& now) {
  if (pose) return output.publish(toPose(*pose, now, kWorldFrame));
  output.publishInvalid(toPose(Eigen::Isometry3d::Identity(), now, kWorldFrame));
}

}  // namespace

NeedlePublisher::NeedlePublisher(Cycle& cycle, const ManipulatorGeometry& geometry, const ManipulatorSetup& rig,
                                 const Micromanipulator& model, double joint_states_rate)
    : geometry_(geometry),
      rig_(rig),
      model_(model),
      joint_states_period_(1 / joint_states_rate),
      measured_(cycle.output<geometry_msgs::PoseStamped>("needle/measured_cp")),
      setpoint_(cycle.output<geometry_msgs::PoseStamped>("needle/setpoint_cp")),
      velocity_(cycle.output<geometry_msgs::TwistStamped>("needle/measured_cv")) {
  if (rig.true_joints) true_ = &cycle.output<geometry_msgs::PoseStamped>("needle/true_cp");
  joint_states_ = cycle.bus().advertise<sensor_msgs::JointState>("joint_states", 10);
  state_ = cycle.bus().advertise<cell_microinjection::OperatingState>("needle/operating_state", 10, true);
  abilities_ = cycle.bus().advertise<cell_microinjection::ManipulatorAbilities>("needle/abilities", 10, true);
  publishAbilities(cycle.bus().now());
}

void NeedlePublisher::publish(const ros::Time& now) {
  publishMotion(now);
  publishAbilities(now);
  if (isDue(joint_states_sent_, now, joint_states_period_)) publishJointStates(now);
}

void NeedlePublisher::publishMotion(const ros::Time& now) {
  publishPose(measured_, model_.tipPose(), now);
  publishPose(setpoint_, model_.setpointPose(), now);
  if (const auto velocity = model_.tipVelocity()) {
    velocity_.publish(toTwist(*velocity, now, kWorldFrame));
  } else {
    velocity_.publishInvalid(toTwist(Eigen::Vector3d::Zero(), now, kWorldFrame));
  }
  if (true_) true_->publish(toPose(geometry_.tipPose(rig_.true_joints()), now, kWorldFrame));
}

bool NeedlePublisher::publishState(cell_microinjection::OperatingState state, const ros::Time& now, bool reply) {
  const bool other = state.state != last_published_state_.state;
  const bool same =
      !other && state.is_homed == last_published_state_.is_homed && state.is_busy == last_published_state_.is_busy;
  if (same && !reply) return false;
  state.header.stamp = now;
  state_.publish(state);
  last_published_state_ = state;
  return other;
}

void NeedlePublisher::publishAbilities(const ros::Time& now) {
  const ManipulatorAbilities abilities = rig_.device->abilities();
  cell_microinjection::ManipulatorAbilities message;
  message.header.stamp = last_published_abilities_.header.stamp;
  message.device = abilities.device;
  message.follows = abilities.follows;
  message.command_interval = abilities.command_interval;
  message.reading_interval = abilities.reading_interval;
  message.resolution = abilities.resolution;
  message.speed = abilities.speed;
  message.latency = abilities.latency;
  message.stop_time = abilities.stop_time;
  // Repeated for subscribers that received another node's abilities meanwhile.
  if (message == last_published_abilities_ && !isDue(last_published_abilities_.header.stamp, now, kAbilitiesPeriod))
    return;
  message.header.stamp = now;
  abilities_.publish(message);
  last_published_abilities_ = message;
}

void NeedlePublisher::publishJointStates(const ros::Time& now) {
  const auto joints = model_.joints();
  if (!joints) return;
  sensor_msgs::JointState message;
  message.header.stamp = now;
  for (int i = 0; i < 3; ++i) {
    message.name.push_back(geometry_.axes[i].joint);
    message.position.push_back((*joints)[i]);
  }
  if (!geometry_.tilt.joint.empty()) {
    message.name.push_back(geometry_.tilt.joint);
    message.position.push_back(geometry_.tilt.angle);
  }
  joint_states_.publish(message);
  joint_states_sent_ = now;
}

}  // namespace microinjection
