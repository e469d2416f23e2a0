#pragma once

#include "cell/identification/curve_fit.h"

namespace microinjection {

/// What chi^2 with one degree of freedom stays below with probability 95 %.
constexpr double kChiSquared95 = 3.841;

/// Interval of an unknown, internal units.
struct ProfileInterval {
  double low = 0, high = 0;
  bool bounded_below = true, bounded_above = true;  ///< else that border is the search's
};

/// Where the best fit with this unknown held has a cost that is `rise` above the smallest one (profile
/// likelihood; Raue et al., Bioinformatics 25 (2009) 1923). `deviation`: where to look first.
ProfileInterval profileInterval(CurveModel& model, const CurveFit& best, int unknown, double rise, double deviation);

}  // namespace microinjection
