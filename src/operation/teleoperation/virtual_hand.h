#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

/// The defaults describe a relaxed pinch grip on a desktop haptic stylus, by the order of magnitude
/// in the literature on grip impedance.
struct VirtualHandConfig {
  double mass = 0.2;         ///< kg, of hand and stylus together
  double damping = 6.0;      ///< N s/m
  double stiffness = 400.0;  ///< N/m

  static VirtualHandConfig read(ConfigReader& reader);
};

/// A simulated hand that holds a haptic device: a mass, with spring and damper to the intended
/// position x_i.
///     mass x'' = stiffness (x_i - x) + damping (x_i' - x') + force
class VirtualHand {
 public:
  VirtualHand(const VirtualHandConfig& config, const Eigen::Vector3d& start)
      : config_(config), position_(start), last_intended_(start) {}

  /// Advances by dt (s) with the intended position (m) and the device's force (N) on the hand;
  /// returns the device's position (m).
  const Eigen::Vector3d& step(const Eigen::Vector3d& intended, const Eigen::Vector3d& force, double dt);

  const Eigen::Vector3d& position() const { return position_; }  ///< m

 private:
  VirtualHandConfig config_;
  Eigen::Vector3d position_;                            ///< m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d last_intended_;                       ///< m
};

}  // namespace microinjection
