#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Residual force after a membrane or contact has failed: a softening spring. It decays
/// exponentially with time and, when the needle moves along it, linearly with that displacement.
/// The needle never gets back more work than `energy`: with V(u) >= 0 the spring's energy at the
/// displacement u, the work is that of the potential g(t) V(u) with decreasing g.
class FadingForce {
 public:
  explicit FadingForce(double relaxation_time) : relaxation_time_(relaxation_time) {}  ///< s, > 0

  /// Starts with `force` N at `tip` m and `time` s. `energy` J is the work that it may return.
  void start(const Eigen::Vector3d& force, const Eigen::Vector3d& tip, double energy, double time);

  /// N, for the tip at `tip`, m; exactly 0 after 21 relaxation times.
  Eigen::Vector3d at(const Eigen::Vector3d& tip, double time) const;

 private:
  double relaxation_time_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), direction_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();
  double fade_distance_ = 0;  ///< m along the force at which it vanishes
  double time_ = 0;           ///< s
};

}  // namespace microinjection
