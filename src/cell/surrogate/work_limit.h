#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Keeps a cell passive whose stored energy changes while a needle presses it: the needle gets back
/// no more work than it has put in since first contact. With that balance W and the cell's stored
/// energy E, the force is scaled by min(1, 4 W / E). So a cell that became up to four times stiffer
/// is felt in full. While the needle leaves, W falls no faster than E^4, and so stays positive, for
/// any force. While it presses, at least a hundredth of the force is felt, from which W grows. The
/// scale is 1 until the cell changes.
class WorkLimit {
 public:
  /// The force (N) that applies at `tip` (m), of `force` on the tip, with `energy` (J) stored. Does
  /// not allocate.
  Eigen::Vector3d step(const Eigen::Vector3d& force, const Eigen::Vector3d& tip, double energy);
  /// The stored energy has changed by itself; from now on the limit applies, until reset().
  void activate() { active_ = true; }
  /// The contact has ended.
  void reset() { *this = WorkLimit(); }

  double work() const { return work_; }  ///< J, of the needle on the cell since first contact

 private:
  bool active_ = false, started_ = false;
  double work_ = 0;
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero(), force_ = Eigen::Vector3d::Zero();  ///< of the last step
};

}  // namespace microinjection
