#pragma once

#include <Eigen/Core>
#include <array>

namespace microinjection {

/// Velocity from the positions of an encoder that resolves 10 to 50 um, which over one period of 1 ms would read as 10
/// to 50 mm/s: first-order adaptive windowing, end-fit (Janabi-Sharifi, Hayward & Chen 2000). The window is the longest
/// one over which a straight line from its oldest to its newest position passes all others within the resolution: long
/// at rest, and short, with little lag, where the motion bends.
class VelocityEstimate {
 public:
  /// `resolution` (m) of the device.
  explicit VelocityEstimate(double resolution) : resolution_(resolution) {}

  void reset() { count_ = 0, value_.setZero(); }
  /// `position` (m), dt (s) after the one before.
  void add(const Eigen::Vector3d& position, double dt);
  const Eigen::Vector3d& value() const { return value_; }  ///< m/s

 private:
  static constexpr int kLongest = 16;  ///< periods

  struct Sample {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
    double time = 0;                                     ///< s, since the reset
  };
  const Sample& back(int i) const { return samples_[(newest_ - i + kLongest + 1) % (kLongest + 1)]; }
  bool straight(int length) const;

  double resolution_;
  std::array<Sample, kLongest + 1> samples_{};
  int newest_ = 0;
  int count_ = 0;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();  ///< m/s
};

}  // namespace microinjection
