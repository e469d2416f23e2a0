#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct VirtualCouplingConfig {
  bool enabled = true;
  double stiffness = 2000.0;  ///< N/m at the hand, largest stiffness that the haptic device renders
  double damping = 20.0;      ///< N s/m
  double lateness = 8e-3;     ///< s, delay of the cell's force: needle, sensor or model, and two periods

  static VirtualCouplingConfig read(ConfigReader reader);
};

/// Spring and damper between the hand and its proxy, the point that the needle follows (Colgate,
/// Stanley & Brown 1995; Adams & Hannaford 1999). The proxy has no mass, so the hand feels the
/// force f of the touched body, and the proxy yields by z:
///     damping z' + stiffness z = f.
/// In series with a rigid body the hand feels `stiffness`, with a soft one of stiffness k
/// 1/(1/stiffness + 1/k): never more than the device can render, and less than the cell alone by k
/// / stiffness (3 % for 60 N/m and the default).
///
/// A sampled spring K with period T and a virtual damper B is passive for a device with damping b
/// when (Colgate & Schenkel 1997)
///     b > K T / 2 + |B|.
/// The damper in series with the cell is not rendered and does not count; contactDamping() counts
/// as B. That theorem does not cover a force delayed by t: slow motion then needs b + B > K t.
/// contactDamping() adds this B for the felt stiffness K: 0.5 N s/m for a cell of 60 N/m (2.4 mN at
/// 5 mm/s), the full damping for a glass wall. The passivity controller covers the rest.
///
/// Small gain: the loop of z over a body of k < stiffness is stable for any delay; stiffer bodies
/// need t < (pi/2) damping / k.
class VirtualCoupling {
 public:
  explicit VirtualCoupling(const VirtualCouplingConfig& config) : config_(config) {}

  /// Damping (N s/m) to render beside the force of a body of this felt stiffness (N/m).
  double contactDamping(double stiffness) const;

  /// Starts at rest under this force (N, at the hand).
  void reset(const Eigen::Vector3d& force) {
    proxy_offset_ = config_.enabled ? Eigen::Vector3d(force / config_.stiffness) : Eigen::Vector3d::Zero();
  }
  /// Advances by dt (s); returns the displacement of the proxy from the hand (m).
  const Eigen::Vector3d& step(const Eigen::Vector3d& force, double dt);
  const Eigen::Vector3d& proxyOffset() const { return proxy_offset_; }  ///< m

 private:
  VirtualCouplingConfig config_;
  Eigen::Vector3d proxy_offset_ = Eigen::Vector3d::Zero();
};

}  // namespace microinjection
