#pragma once

#include <Eigen/Core>

namespace microinjection {

/// What is left of a force after that which gave it has failed: a spring that softens. It falls exponentially with the
/// time and, where the needle gives way to it, linearly with the way, so that the needle never gets more work back than
/// `energy`: with V(u) >= 0 the spring's energy at the way u, its work is that of the potential g(t) V(u), g falling.
class FadingForce {
 public:
  explicit FadingForce(double relaxation_time) : relaxation_time_(relaxation_time) {}  ///< s, > 0

  /// `force` N at `tip` m and `time` s; `energy` J, that may come back.
  void start(const Eigen::Vector3d& force, const Eigen::Vector3d& tip, double energy, double time);

  /// N, for the tip at `tip`, m; exactly 0 after 21 relaxation times.
  Eigen::Vector3d at(const Eigen::Vector3d& tip, double time) const;

 private:
  double relaxation_time_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), direction_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();
  double way_ = 0;   ///< m along the force at which nothing of it is left
  double time_ = 0;  ///< s
};

}  // namespace microinjection
