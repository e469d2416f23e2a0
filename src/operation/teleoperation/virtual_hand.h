#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

/// Defaults: a relaxed pinch grip on a desktop haptic stylus, the order of magnitude that the literature on grip
/// impedance reports.
struct VirtualHandConfig {
  double mass = 0.2;         ///< kg, of hand and stylus together
  double damping = 6.0;      ///< N s/m
  double stiffness = 400.0;  ///< N/m

  static VirtualHandConfig read(ConfigReader& reader);
};

/// A hand that holds a haptic device: mass, damper and spring between where it means to be and where the force lets it.
///     mass x'' = stiffness (x_meant - x) + damping (x_meant' - x') + force
class VirtualHand {
 public:
  VirtualHand(const VirtualHandConfig& config, const Eigen::Vector3d& start)
      : config_(config), position_(start), intended_(start) {}

  /// Advances by dt (s) with the device's force (N) on the hand; returns the device's position (m).
  const Eigen::Vector3d& step(const Eigen::Vector3d& meant, const Eigen::Vector3d& force, double dt);

  const Eigen::Vector3d& position() const { return position_; }  ///< m

 private:
  VirtualHandConfig config_;
  Eigen::Vector3d position_;                            ///< m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d intended_;                            ///< m, of the step before
};

}  // namespace microinjection
