#pragma once

#include <Eigen/Core>
#include <string>

namespace microinjection {

/// Latches when a load exceeds the limit of a sensor, until it is reset.
class OverloadLatch {
 public:
  /// `limit` (N): (axial, lateral).
  explicit OverloadLatch(const Eigen::Vector2d& limit) : limit_(limit) {}

  void check(const Eigen::Vector2d& load);
  bool latched() const { return latched_; }
  /// The largest load since then, and how many times its limit it is; a force of another unit is named: "1.2 N along
  /// the pipette, 600 times axial_overload = 0.002 N (mN for N?)". Empty: not latched.
  std::string text() const;
  const Eigen::Vector2d& limit() const { return limit_; }  ///< N
  void reset() { *this = OverloadLatch(limit_); }

 private:
  Eigen::Vector2d limit_;
  Eigen::Vector2d largest_ = Eigen::Vector2d::Zero();  ///< N, since it latched
  bool latched_ = false;
};

}  // namespace microinjection
