#pragma once

#include <array>

#include "base/config_reader.h"

namespace microinjection {

struct HysteresisConfig {
  double width = 0;     ///< m, between forward and return path of the saturated loop
  double range = 5e-6;  ///< m, of motion from rest to saturation

  static HysteresisConfig read(ConfigReader& reader);
};

/// Rate-independent hysteresis of a piezo or of a flexure with friction: a Prandtl-Ishlinskii
/// model. The output is the input minus a sum of stop operators of equal weight, elastic up to a
/// threshold and sliding beyond. The thresholds are spread evenly over `range`. K. Kuhnen,
/// Modeling, Identification and Compensation of Complex Hysteretic Nonlinearities: A Modified
/// Prandtl-Ishlinskii Approach, European Journal of Control 9 (2003) 407-418.
class Hysteresis {
 public:
  static constexpr int kStops = 8;

  explicit Hysteresis(const HysteresisConfig& config = {});

  /// Output (m) after the input has moved monotonically to `input` (m).
  double follow(double input);

 private:
  HysteresisConfig config_;
  double weight_ = 0;                     ///< 1
  double input_ = 0;                      ///< m
  std::array<double, kStops> strains_{};  ///< m, of each stop
};

}  // namespace microinjection
