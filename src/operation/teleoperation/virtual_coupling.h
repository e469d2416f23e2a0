#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct VirtualCouplingConfig {
  bool enabled = true;
  double stiffness = 2000.0;  ///< N/m at the hand, the stiffest that the haptic device renders
  double damping = 20.0;      ///< N s/m
  double lateness = 8e-3;     ///< s, by which the cell's force comes late: needle, sensor or model, and two periods

  static VirtualCouplingConfig read(ConfigReader reader);
};

/// Spring and damper between the hand and its proxy, the point that the needle follows (Colgate, Stanley & Brown 1995;
/// Adams & Hannaford 1999). The proxy has no mass, so the force f of what is touched goes through to the hand, and the
/// proxy yields by z:
///     damping z' + stiffness z = f.
/// In series with a rigid thing the hand feels `stiffness`, with a soft one 1/(1/stiffness + 1/k): never more than the
/// device can render, and less than the cell alone by k / stiffness (3 % for 60 N/m and the default).
///
/// A sampled spring K with period T and a virtual damper B is passive for a device with damping b when (Colgate &
/// Schenkel 1997)
///     b > K T / 2 + |B|.
/// The damper in series with the cell is not rendered and does not count; contactDamping() does, as B. A force that
/// comes late by t is beyond that theorem: slow motion needs b + B > K t, and that is what contactDamping() adds for
/// the stiffness K that is felt: 0.5 N s/m for a cell of 60 N/m (2.4 mN at 5 mm/s), the whole damping for a glass wall.
/// What is left to lack is the passivity controller's.
///
/// Small gain: the loop of z over a thing of k < stiffness is stable whatever its delay; stiffer ones need
/// t < (pi/2) damping / k.
class VirtualCoupling {
 public:
  explicit VirtualCoupling(const VirtualCouplingConfig& config) : config_(config) {}

  /// N/m: the stiffest sampled spring that is passive with a device's `damping` (N s/m), the virtual one (N s/m) and
  /// `period` (s); negative: none.
  static double passiveStiffness(double damping, double virtual_damping, double period) {
    return 2 * (damping - virtual_damping) / period;
  }

  /// Damping (N s/m) to render beside the force of something that feels as stiff as this (N/m).
  double contactDamping(double stiffness) const;

  /// Begins with this force (N, at the hand), at rest.
  void reset(const Eigen::Vector3d& force) {
    proxy_offset_ = config_.enabled ? Eigen::Vector3d(force / config_.stiffness) : Eigen::Vector3d::Zero();
  }
  /// Advances by dt (s); returns by how much the proxy is off the hand (m).
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, double dt);
  const Eigen::Vector3d& proxyOffset() const { return proxy_offset_; }  ///< m

 private:
  VirtualCouplingConfig config_;
  Eigen::Vector3d proxy_offset_ = Eigen::Vector3d::Zero();
};

}  // namespace microinjection
