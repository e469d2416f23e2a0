#pragma once

#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/guards.h"

namespace microinjection {

/// Intervals of 95 % of the force and the depth at which the next membrane is expected to fail.
struct ExpectedPuncture {
  double force_low = 0, force_high = 0;  ///< N, along the pipette
  double depth_low = 0, depth_high = 0;  ///< m past the contact point

  /// Whether both intervals are finite, positive and in order. A prediction that is not is none.
  bool plausible() const;
};

/// What the controller does with an expected puncture.
struct ExpectationConfig {
  double timeout = 0.5;  ///< s, after which a prediction counts as none
  double beyond = 0.5;   ///< share of force_high, by which the force may exceed it

  void read(ConfigReader& reader);
};

/// Reason not to begin the way to a puncture: no part of an interval is within the limits. Empty: none.
/// @param depth  m, the goal's
std::string unreachable(const ExpectedPuncture& expected, const GuardConfig& guards, double depth);

/// Reason not to go deeper: the membrane holds more than this cell's could. Empty: none.
/// @param force  N, along the pipette, above the offset
std::string exceeded(const ExpectedPuncture& expected, const ExpectationConfig& config, double force);

}  // namespace microinjection
