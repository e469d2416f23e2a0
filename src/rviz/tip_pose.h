#pragma once

#include <tf2_ros/buffer.h>

#include <Eigen/Geometry>
#include <optional>

#include "nodes/runtime/stamps.h"

namespace microinjection {

/// The newest pose of the needle's tip in `world`; empty: it is older than `largest_age` (s), or not known.
inline std::optional<Eigen::Isometry3d> tipPose(const tf2_ros::Buffer& frames, const ros::Time& now,
                                                double largest_age) {
  if (!frames.canTransform("world", "needle_tip", ros::Time(0))) return std::nullopt;
  try {
    const auto stamped = frames.lookupTransform("world", "needle_tip", ros::Time(0));
    if (secondsBetween(stamped.header.stamp, now) > largest_age) return std::nullopt;
    const auto& q = stamped.transform.rotation;
    const auto& p = stamped.transform.translation;
    return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

}  // namespace microinjection
