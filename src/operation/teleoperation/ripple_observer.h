#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct RippleConfig {
  double cutoff = 2.0;      ///< Hz, of the high-pass of force and motion
  double tolerance = 2e-5;  ///< J, largest loss that does not count as oscillation
  double memory = 2.0;      ///< s, after which a loss is forgotten

  /// The keys of the same names.
  static RippleConfig read(ConfigReader reader);
};

/// Detects an oscillation fed by the energy that the loop generates, before it has used up the
/// energy stored by indentation.
///
/// The touched body's force rises with depth, so the body is passive about any depth. With force
/// and position high-passed alike, a spring has f~ = -K x~. The energy -f~ . dx~ taken from the
/// hand, less the half of -f~ . x~ that a spring stores, is then constantly 0. Damping raises it; a
/// late force lowers it in every period of an oscillation. The fall is the deficit that damping of
/// the ripple dissipates.
class RippleObserver {
 public:
  explicit RippleObserver(const RippleConfig& config) : config_(config) {}

  void reset() { *this = RippleObserver(config_); }
  /// Counts the period dt (s) that has passed: `force` (N) as rendered in it, `position` (m) of the
  /// hand at its end.
  void observe(const Eigen::Vector3d& force, const Eigen::Vector3d& position, double dt);
  double energy_deficit() const;                                 ///< J, beyond the tolerance
  const Eigen::Vector3d& velocity() const { return velocity_; }  ///< m/s, of the ripple

 private:
  RippleConfig config_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), last_force_ = Eigen::Vector3d::Zero();        ///< N
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), last_position_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();                                            ///< m/s
  double balance_ = 0;                                                                            ///< J
  bool begun_ = false;
};

}  // namespace microinjection
