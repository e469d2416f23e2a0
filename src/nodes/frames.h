#pragma once

#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace microinjection {

/// The newest pose of `frame` in `parent` that tf knows; empty when it knows none.
std::optional<Eigen::Isometry3d> findFrame(const tf2_ros::Buffer& buffer, const std::string& parent,
                                           const std::string& frame);

/// Waits up to `timeout` (s of wall time, since a simulated clock may not run yet) for a fixed pose.
/// @throws ConfigError that says what is missing and who should say it
Eigen::Isometry3d waitForFrame(const std::string& parent, const std::string& frame, double timeout);

}  // namespace microinjection
