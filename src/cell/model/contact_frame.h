#pragma once

#include <Eigen/Core>
#include <optional>

#include "cell/contact/rounded_tip.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Where a needle that comes down along z meets the undeformed cell, and the frame in which its displacement counts:
/// x away from the cell's axis, z up. On the axis x is that of the world.
struct ContactFrame {
  double angle = 0;                                        ///< rad, of the place from the pole, seen from the centre
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();        ///< m, of the tip (its lowest point, or a disc's centre)
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< from the frame of the place to the world's

  /// Of the needle whose line is at `offset` (x, y; m). Nothing when it passes by.
  static std::optional<ContactFrame> at(const Scene& scene, const Eigen::Vector2d& offset);
  /// The same for a cell of `radius` (m) and a rounded tip, or none: a disc. Allocates nothing.
  static std::optional<ContactFrame> at(double radius, const std::optional<RoundedTip>& tip,
                                        const Eigen::Vector2d& offset);

  /// Offset, m, at which a needle meets the cell at `angle` (rad) on the x axis.
  static Eigen::Vector2d offsetFor(const Scene& scene, double angle);
};

}  // namespace microinjection
