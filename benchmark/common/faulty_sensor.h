#pragma once

#include <functional>
#include <optional>
#include <random>
#include <string>

#include "hardware/sensor/force_sensor.h"

namespace microinjection {

/// Readings of the virtual force sensor at 1 kHz, some of them bad.
class FaultySensor {
 public:
  static constexpr double kRate = 1000;  ///< Hz

  /// `fault`: outliers (3 % of the readings), dropouts (of 20 ms), freeze (for 30 ms); of any other word none.
  /// `outlier`: N, of one. `noise`: factor of its noise of 10 nN, its
  /// converter's step and its range.
  FaultySensor(const std::string& fault, double outlier, int seed, double noise = 1);

  /// N; none during a dropout. `force`: N, of a time (s).
  std::optional<double> read(double time, const std::function<double(double)>& force, std::mt19937& random);

 private:
  std::string fault_;
  double outlier_, frozen_ = 0;
  int hold_ = 0;  ///< readings until the fault is over
  ForceSensor sensor_;
};

}  // namespace microinjection
