#pragma once

#include <string>

#include "cell/identification/force_curve.h"

namespace microinjection {

/// First estimate of what a record holds, from straight lines and a power of the depth.
struct ContactGuess {
  bool touched = false;  ///< else `reason` says why there is no contact to fit
  std::string reason;
  double contact = 0;  ///< m
  double offset = 0;   ///< N, at the first sample
  double drift = 0;    ///< N/s
  double size = 0;     ///< N, of the cell's force at the deepest sample
  double depth = 0;    ///< m, of the deepest sample
  double noise = 0;    ///< N, standard deviation of a sample
};

ContactGuess guessContact(const ForceCurve& curve, bool drift);

}  // namespace microinjection
