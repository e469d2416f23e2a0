#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct RippleConfig {
  double cutoff = 2.0;      ///< Hz, of the high-pass that force and motion go through
  double tolerance = 2e-5;  ///< J, a loss that is no oscillation
  double memory = 2.0;      ///< s, after which a loss is forgotten

  /// The keys of the same names.
  static RippleConfig read(ConfigReader reader);
};

/// Finds the oscillation that lives on energy which the loop makes, before it has used up what was stored by pressing
/// in.
///
/// What is touched is a rising function of depth, so about any depth it is passive for itself: with force and position
/// high-passed alike, a spring has f~ = -K x~, and the energy -f~ . dx~ taken from the hand less the half of -f~ . x~
/// that a spring holds is constant: 0. Damping lets it rise, force that comes late lets it fall in every period of an
/// oscillation. What has fallen is owed as damping of the ripple.
class RippleObserver {
 public:
  explicit RippleObserver(const RippleConfig& config) : config_(config) {}

  void reset() { *this = RippleObserver(config_); }
  /// The period of dt (s) that has passed: `force` (N) as rendered in it, `position` (m) of the hand at its end.
  void observe(const Eigen::Vector3d& force, const Eigen::Vector3d& position, double dt);
  double energy_deficit() const;                                 ///< J, past the tolerance
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
