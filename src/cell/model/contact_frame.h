#pragma once

#include <Eigen/Core>
#include <optional>

#include "cell/contact/rounded_tip.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Contact point of a needle that moves down along z to the undeformed cell, and the frame of its
/// displacement: x away from the cell's axis, z up. On the axis x is that of the world.
struct ContactFrame {
  double angle = 0;                                        ///< rad, of the contact point from the pole
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();        ///< m, of the tip (its lowest point, or a disc's centre)
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from the contact frame to the world's

  /// For a needle whose line is at `offset` (x, y; m). Empty when it passes the cell.
  static std::optional<ContactFrame> at(const Scene& scene, const Eigen::Vector2d& offset);
  /// Same for a cell of `radius` (m) and a rounded tip, or none: a disc. Does not allocate.
  static std::optional<ContactFrame> at(double radius, const std::optional<RoundedTip>& tip,
                                        const Eigen::Vector2d& offset);

  /// Offset, m, for which a needle meets the cell at `angle` (rad) on the x axis.
  static Eigen::Vector2d offsetFor(const Scene& scene, double angle);
};

}  // namespace microinjection
