#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Latches when a load exceeds the limit of a sensor, until it is reset.
class OverloadLatch {
 public:
  /// `limit` (N): (axial, lateral).
  explicit OverloadLatch(const Eigen::Vector2d& limit) : limit_(limit) {}

  void check(const Eigen::Vector2d& load) { latched_ = latched_ || (load.cwiseAbs().array() > limit_.array()).any(); }
  bool latched() const { return latched_; }
  const Eigen::Vector2d& limit() const { return limit_; }  ///< N
  void reset() { latched_ = false; }

 private:
  Eigen::Vector2d limit_;
  bool latched_ = false;
};

}  // namespace microinjection
