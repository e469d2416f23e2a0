#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Corrects the force of an energy towards a more accurate, non-conservative one without creating
/// energy. The energy that the correction has taken from the needle in this contact is stored in a
/// tank, and it returns no more than that (energy tanks: Franken et al., IEEE Trans. Robotics 27
/// (2011) 741). The energy is reduced by a reserve that fills the tank during indentation, so that
/// on simple paths the whole correction applies.
class PassiveCorrection {
 public:
  /// Share of the energy that is reserved for the correction.
  static constexpr double kReserve = 0.03;

  /// The part of `wanted` (N) that applies at `displacement` (m, of the tip since first contact),
  /// at the total energy `energy` (J). Does not allocate.
  Eigen::Vector3d step(const Eigen::Vector3d& displacement, const Eigen::Vector3d& wanted, double energy);
  void reset() { *this = PassiveCorrection(); }
  /// The cell's energy has changed by a factor.
  void scale(double factor) {
    applied_ *= factor;
    tank_ *= factor;
  }

 private:
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();  ///< m, of the last step
  Eigen::Vector3d applied_ = Eigen::Vector3d::Zero();       ///< N, in the last step
  double tank_ = 0;                                         ///< J
};

}  // namespace microinjection
