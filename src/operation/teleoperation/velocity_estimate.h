#pragma once

#include <Eigen/Core>
#include <array>

namespace microinjection {

/// Velocity from encoder positions with a resolution of 10 to 50 um, whose differences over a
/// period of 1 ms are steps of 10 to 50 mm/s. Method: first-order adaptive windowing, end-fit
/// (Janabi-Sharifi, Hayward & Chen 2000). The window is the longest in which the straight line from
/// the oldest to the newest position passes all others within the resolution. It is long at rest,
/// and short, with little lag, where the velocity changes.
class VelocityEstimate {
 public:
  /// `resolution` (m) of the device.
  explicit VelocityEstimate(double resolution) : resolution_(resolution) {}

  void reset() { count_ = 0, value_.setZero(); }
  /// Adds a position (m), dt (s) after the last one.
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
