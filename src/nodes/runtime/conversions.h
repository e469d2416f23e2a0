#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace microinjection {

constexpr char kWorldFrame[] = "world";
constexpr char kTipFrame[] = "needle_tip";
constexpr char kHapticFrame[] = "haptic";  ///< of a device without a frame of its own

// A finite number can still be unusable: the square of 1e160 is not finite. Values that no rig,
// hand or sensor reaches are invalid.
constexpr double kLargestNeedleDistance = 1;  ///< m from the origin of `world`, which is in the dish
constexpr double kLargestHandDistance = 10;   ///< m from the origin of the device's frame
constexpr double kLargestSpeed = 10;          ///< m/s
constexpr double kLargestForce = 1e3;         ///< N

/// The vector of a message with x, y and z.
template <typename Message>
Eigen::Vector3d toVector(const Message& message) {
  return {message.x, message.y, message.z};
}
/// A message with x, y and z.
template <typename Message>
Message toMessage(const Eigen::Vector3d& vector) {
  Message message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

/// The quaternion of a rotation.
geometry_msgs::Quaternion toQuaternion(const Eigen::Matrix3d& rotation);

/// Whether a vector is finite and no coordinate is larger than `largest`.
bool isWithin(const Eigen::Vector3d& vector, double largest);

/// A pose in `world`. Empty when the message is null, has stamp 0, is in another frame (an empty
/// frame_id counts as world), is not finite or beyond kLargestNeedleDistance, or its quaternion is
/// not of unit length within 1e-3.
std::optional<Eigen::Isometry3d> validPose(const geometry_msgs::PoseStamped* message);

/// A velocity (m/s) in `world`; empty in the same cases, or beyond kLargestSpeed.
std::optional<Eigen::Vector3d> validVelocity(const geometry_msgs::TwistStamped* message);

/// The position (m) alone, checked like validPose but for the orientation, in `frame`, up to
/// `largest` (m) from its origin.
std::optional<Eigen::Vector3d> validPosition(const geometry_msgs::PoseStamped* message, const std::string& frame,
                                             double largest = kLargestNeedleDistance);

/// A force (N) in `world`, from a message in `world` (or without frame) or in `needle_tip`, whose
/// orientation in world is `tip`. Empty when the message is null, in another frame, not finite or
/// beyond kLargestForce.
std::optional<Eigen::Vector3d> validForce(const geometry_msgs::WrenchStamped* message, const Eigen::Matrix3d& tip);

/// A force (N) in the message's own frame, whatever it is: a haptic device's frame depends on its
/// driver. Empty when the message is null, not finite or beyond kLargestForce.
std::optional<Eigen::Vector3d> finiteForce(const geometry_msgs::WrenchStamped* message);

geometry_msgs::PoseStamped toPose(const Eigen::Isometry3d& pose, const ros::Time& stamp, const std::string& frame);
/// A pose with the identity as orientation.
geometry_msgs::PoseStamped toPose(const Eigen::Vector3d& position, const ros::Time& stamp, const std::string& frame);
geometry_msgs::WrenchStamped toWrench(const Eigen::Vector3d& force, const ros::Time& stamp, const std::string& frame);
/// The pose of the frame `child` in `parent`.
geometry_msgs::TransformStamped toTransform(const Eigen::Isometry3d& pose, const ros::Time& stamp,
                                            const std::string& parent, const std::string& child);
geometry_msgs::TwistStamped toTwist(const Eigen::Vector3d& velocity, const ros::Time& stamp, const std::string& frame);

}  // namespace microinjection
