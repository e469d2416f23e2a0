#include "nodes/runtime/conversions.h"

#include <cmath>

namespace microinjection {
namespace {

bool isIn(const std::string& frame, const std::string& wanted) { return frame.empty() || frame == wanted; }

}  // namespace

geometry_msgs::Quaternion toQuaternion(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond quaternion(rotation);
  geometry_msgs::Quaternion message = toMessage<geometry_msgs::Quaternion>(quaternion.vec());
  message.w = quaternion.w();
  return message;
}

bool isWithin(const Eigen::Vector3d& vector, double largest) {
  // The norm's squares may overflow.
  return vector.allFinite() && vector.cwiseAbs().maxCoeff() <= largest;
}

std::optional<Eigen::Vector3d> validPosition(const geometry_msgs::PoseStamped* message, const std::string& frame,
                                             double largest) {
  if (!message || message->header.stamp.isZero() || !isIn(message->header.frame_id, frame)) return std::nullopt;
  const Eigen::Vector3d position = toVector(message->pose.position);
  if (!isWithin(position, largest)) return std::nullopt;
  return position;
}

std::optional<Eigen::Isometry3d> validPose(const geometry_msgs::PoseStamped* message) {
  const auto position = validPosition(message, kWorldFrame);
  if (!position) return std::nullopt;
  const auto& q = message->pose.orientation;
  const Eigen::Quaterniond orientation(q.w, q.x, q.y, q.z);
  if (!(std::abs(orientation.norm() - 1) < 1e-3)) return std::nullopt;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = orientation.normalized().toRotationMatrix();
  pose.translation() = *position;
  return pose;
}

std::optional<Eigen::Vector3d> validVelocity(const geometry_msgs::TwistStamped* message) {
  if (message->header.stamp.isZero() || !isIn(message->header.frame_id, kWorldFrame)) return std::nullopt;
  const Eigen::Vector3d velocity = toVector(message->twist.linear);
  if (!isWithin(velocity, kLargestSpeed)) return std::nullopt;
  return velocity;
}

std::optional<Eigen::Vector3d> finiteForce(const geometry_msgs::WrenchStamped* message) {
  if (!message) return std::nullopt;
  const Eigen::Vector3d force = toVector(message->wrench.force);
  if (!isWithin(force, kLargestForce)) return std::nullopt;
  return force;
}

std::optional<Eigen::Vector3d> validForce(const geometry_msgs::WrenchStamped* message, const Eigen::Matrix3d& tip) {
  auto force = finiteForce(message);
  if (!force || isIn(message->header.frame_id, kWorldFrame)) return force;
  if (message->header.frame_id == kTipFrame) return Eigen::Vector3d(tip * *force);
  return std::nullopt;
}

geometry_msgs::PoseStamped toPose(const Eigen::Isometry3d& pose, const ros::Time& stamp, const std::string& frame) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame;
  message.pose.position = toMessage<geometry_msgs::Point>(pose.translation());
  message.pose.orientation = toQuaternion(pose.linear());
  return message;
}

geometry_msgs::PoseStamped toPose(const Eigen::Vector3d& position, const ros::Time& stamp, const std::string& frame) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  return toPose(pose, stamp, frame);
}

geometry_msgs::WrenchStamped toWrench(const Eigen::Vector3d& force, const ros::Time& stamp, const std::string& frame) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame;
  message.wrench.force = toMessage<geometry_msgs::Vector3>(force);
  return message;
}

geometry_msgs::TransformStamped toTransform(const Eigen::Isometry3d& pose, const ros::Time& stamp,
                                            const std::string& parent, const std::string& child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation = toMessage<geometry_msgs::Vector3>(pose.translation());
  message.transform.rotation = toQuaternion(pose.linear());
  return message;
}

geometry_msgs::TwistStamped toTwist(const Eigen::Vector3d& velocity, const ros::Time& stamp, const std::string& frame) {
  geometry_msgs::TwistStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = frame;
  message.twist.linear = toMessage<geometry_msgs::Vector3>(velocity);
  return message;
}

}  // namespace microinjection
