#pragma once

#include <array>

#include "base/config_reader.h"

namespace microinjection {

struct HysteresisConfig {
  double width = 0;     ///< m, between the way there and the way back once the loop is saturated
  double range = 5e-6;  ///< m, of motion from rest until it is

  static HysteresisConfig read(ConfigReader& reader);
};

/// Hysteresis of a piezo or of a flexure with friction, which does not depend on speed: a Prandtl-Ishlinskii model,
/// the input less a sum of stop operators (elastic up to a threshold, then sliding) of equal weight with thresholds
/// spread evenly over `range`.
/// K. Kuhnen, Modeling, Identification and Compensation of Complex Hysteretic Nonlinearities: A Modified
/// Prandtl-Ishlinskii Approach, European Journal of Control 9 (2003) 407-418.
class Hysteresis {
 public:
  static constexpr int kStops = 8;

  explicit Hysteresis(const HysteresisConfig& config = {});

  /// The output (m) after the input has gone straight from where it was to `input` (m).
  double follow(double input);

 private:
  HysteresisConfig config_;
  double weight_ = 0;                     ///< 1
  double input_ = 0;                      ///< m
  std::array<double, kStops> strains_{};  ///< m, of each stop
};

}  // namespace microinjection
