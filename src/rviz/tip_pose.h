#pragma once

#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <optional>

namespace microinjection {

/// The newest pose of the needle's tip in `world`; empty: it is older than `largest_age` (s), or not known.
std::optional<Eigen::Isometry3d> tipPose(const tf2_ros::Buffer& frames, const ros::Time& now, double largest_age);

}  // namespace microinjection
