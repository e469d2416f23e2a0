#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>

#include "base/config_reader.h"

namespace microinjection {

/// Defaults are illustrative figures of a two-axis capacitive MEMS cellular force sensor (after Sun and Nelson).
struct ForceSensorConfig {
  double axial_range = 490e-6;      ///< N, along the pipette
  double lateral_range = 900e-6;    ///< N, across the pipette
  double axial_noise = 10e-9;       ///< N rms at the sample rate
  double lateral_noise = 240e-9;    ///< N rms at the sample rate
  double natural_frequency = 1500;  ///< Hz, of the second-order response
  double damping_ratio = 0.7;       ///< 1
  double cross_axis = 0.02;         ///< 1, share of each axis that shows on the other
  int bits = 16;                    ///< of the converter
  int seed = 1;                     ///< of the noise

  static ForceSensorConfig read(ConfigReader& reader);
};

/// What a two-axis force sensor at the pipette reports of the force on the tip.
class ForceSensor {
 public:
  explicit ForceSensor(const ForceSensorConfig& config);

  /// Advances by dt (s) under a constant tip force (N) given along `x` = (axial, lateral); returns the reading (N).
  /// @pre finite force; the caller keeps a reading of an untrusted force from being published.
  Eigen::Vector2d sample(const Eigen::Vector2d& force, double dt);

  /// True when the last reading was cut off at the range of an axis.
  bool saturated() const { return saturated_; }

 private:
  void respond(const Eigen::Vector2d& force, double dt);

  ForceSensorConfig config_;
  std::mt19937_64 random_;
  Eigen::Matrix2d state_ = Eigen::Matrix2d::Zero();       ///< column an axis: deflection as force (N), its rate (N/s)
  Eigen::Matrix2d transition_ = Eigen::Matrix2d::Zero();  ///< of the deviation from rest over transition_dt_
  double transition_dt_ = 0;                              ///< s
  bool saturated_ = false;
};

}  // namespace microinjection
