#include "nodes/needle/rig_frames_node.h"

#include <Eigen/Geometry>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

Eigen::Isometry3d poseOf(const Eigen::Matrix<double, 6, 1>& numbers) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = numbers.head<3>();
  pose.rotate(Eigen::AngleAxisd(numbers[3], Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(numbers[4], Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(numbers[5], Eigen::Vector3d::UnitX()));
  return pose;
}

}  // namespace

const char* const RigFramesNode::kHelp =
    "rig_frames: the frames of the rig in virtual time.\n"
    "In: joint_states. Out: /tf /tf_static.\n";

RigFramesNode::RigFramesNode(Bus& bus)
    : bus_(bus),
      static_frames_(bus.advertise<tf2_msgs::TFMessage>("/tf_static", 10, true)),
      moving_frames_(bus.advertise<tf2_msgs::TFMessage>("/tf", 100)) {
  const YAML::Node urdf = bus.parameter("/robot_description");
  if (!urdf.IsScalar()) throw ConfigError("/robot_description is missing: it must hold the rig's URDF (urdf/rig.urdf)");
  model_ = parseRig(urdf.Scalar());
  for (const auto& [name, joint] : model_->joints_) {
    if (joint->type != urdf::Joint::FIXED) continue;
    fixed_.push_back(toTransform(toEigen(joint->parent_to_joint_origin_transform), bus.now(), joint->parent_link_name,
                                 joint->child_link_name));
  }
  ConfigReader reader = parameterReader(bus);
  for (ConfigReader& frame : reader.sections("frames")) {
    std::string parent, child;
    Eigen::Matrix<double, 6, 1> numbers = Eigen::Matrix<double, 6, 1>::Zero();
    frame.text("parent", parent, ConfigReader::kRequired);
    frame.text("child", child, ConfigReader::kRequired);
    frame.vector("pose", numbers);
    fixed_.push_back(toTransform(poseOf(numbers), bus.now(), parent, child));
  }
  reader.finish();
  tf2_msgs::TFMessage message;
  message.transforms = fixed_;
  static_frames_.publish(message);
  joints_ = subscribeGuarded(bus, "joint_states", 10, &RigFramesNode::onJoints, this);
}

void RigFramesNode::onJoints(const sensor_msgs::JointState& message) {
  tf2_msgs::TFMessage frames;
  for (std::size_t i = 0; i < message.name.size() && i < message.position.size(); ++i) {
    const urdf::JointConstSharedPtr joint = model_->getJoint(message.name[i]);
    if (!joint || joint->type == urdf::Joint::FIXED) continue;
    Eigen::Isometry3d pose = toEigen(joint->parent_to_joint_origin_transform);
    const Eigen::Vector3d axis(joint->axis.x, joint->axis.y, joint->axis.z);
    if (joint->type == urdf::Joint::PRISMATIC) {
      pose.translate(message.position[i] * axis);
    } else {
      pose.rotate(Eigen::AngleAxisd(message.position[i], axis));
    }
    frames.transforms.push_back(
        toTransform(pose, message.header.stamp, joint->parent_link_name, joint->child_link_name));
  }
  moving_frames_.publish(frames);
}

}  // namespace microinjection
