#pragma once

#include <Eigen/Core>

#include "cell/model/puncture_config.h"

namespace microinjection {

/// Forces of a cell on the shaft of a needle in it.
///
/// Along the pipette a spring sticks to the shaft and slips when its force exceeds friction plus
/// adhesion times length (Dupont, Hayward, Armstrong, Altpeter, "Single state elastoplastic
/// friction models", IEEE Transactions on Automatic Control 47(5), 2002, with slip without creep):
/// independent of rate, continuous along any path, without drift at rest. Slip and a shorter shaft
/// only take energy from the spring. Across the pipette a spring pulls to the point of entry. In
/// all directions a drag of damping times length times velocity acts.
class ShaftResistance {
 public:
  explicit ShaftResistance(const PunctureConfig::Shaft& config) : config_(config) {}

  /// The needle enters at `tip`, m, with relaxed springs.
  void enter(const Eigen::Vector3d& tip);

  /// Force, N, on the tip at `tip`, m, `duration` s after the last step, with `length` m of shaft
  /// in the cytoplasm and the pipette along `axis` (unit, out of the cell).
  Eigen::Vector3d step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double length, double duration);

 private:
  PunctureConfig::Shaft config_;
  Eigen::Vector3d entered_at_ = Eigen::Vector3d::Zero(), last_ = Eigen::Vector3d::Zero();  ///< m
  double spring_origin_ = 0;  ///< m along the axis, elongation of the spring that sticks to the shaft
};

}  // namespace microinjection
