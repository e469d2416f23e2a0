#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Adds to the force of an energy what a better, non-conservative one differs by, as long as that creates no energy:
/// what the correction has taken from the needle in this contact is kept as in a tank, and it gives back no more than
/// that (energy tanks: Franken et al., IEEE Trans. Robotics 27 (2011) 741). The energy is made smaller by a reserve,
/// which the correction takes up on the way in, so that on simple paths the tank is full and the correction applies as
/// a whole.
class PassiveCorrection {
 public:
  /// Of the energy: left to the correction.
  static constexpr double kReserve = 0.03;

  /// The part of `wanted` (N) that applies at `displacement` (m, of the tip since it touched), where the whole energy
  /// is `energy` (J). Allocates nothing.
  Eigen::Vector3d step(const Eigen::Vector3d& displacement, const Eigen::Vector3d& wanted, double energy);
  void reset() { *this = PassiveCorrection(); }

  double stored() const { return tank_; }  ///< J

 private:
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();  ///< m, of the last step
  Eigen::Vector3d applied_ = Eigen::Vector3d::Zero();       ///< N, there
  double tank_ = 0;                                         ///< J
};

}  // namespace microinjection
