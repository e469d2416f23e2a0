#include "nodes/frames.h"

#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <sstream>

#include "base/errors.h"

namespace microinjection {

std::optional<Eigen::Isometry3d> findFrame(const tf2_ros::Buffer& buffer, const std::string& parent,
                                           const std::string& frame) {
  try {
    const auto transform = buffer.lookupTransform(parent, frame, ros::Time(0)).transform;
    const auto& t = transform.translation;
    const auto& q = transform.rotation;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    pose.translation() << t.x, t.y, t.z;
    return pose;
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Eigen::Isometry3d waitForFrame(const std::string& parent, const std::string& frame, double timeout) {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  const ros::SteadyTime began = ros::SteadyTime::now();
  while (ros::ok() && (ros::SteadyTime::now() - began).toSec() <= timeout) {
    if (const auto pose = findFrame(buffer, parent, frame)) return *pose;
    ros::WallDuration(0.01).sleep();
  }
  std::ostringstream message;
  message << "tf has had no way from frame '" << frame << "' to '" << parent << "' for " << timeout
          << " s: a static_transform_publisher, as in the node's launch file, or robot_state_publisher must tell it";
  throw ConfigError(message.str());
}

}  // namespace microinjection
