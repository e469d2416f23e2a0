#pragma once

#include <algorithm>

namespace microinjection {

/// Value and slope of a convex function of one variable.
struct ValueSlope {
  double value = 0;
  double slope = 0;
};

/// Minimum of a convex function `f(x) -> ValueSlope` over [0, 1], to `accuracy`. If the minimum is
/// certainly above `enough`, some lower bound above `enough` is returned early. Two tangents bound
/// the minimum from below. Their intersection is the next trial point, or the middle of the
/// interval if that shrinks it too slowly (Kelley's cutting planes).
template <typename Function>
double convexMinimum(const Function& f, double accuracy, double enough) {
  double left = 0, right = 1;
  ValueSlope at_left = f(left);
  if (at_left.slope >= 0) return at_left.value;
  ValueSlope at_right = f(right);
  if (at_right.slope <= 0) return at_right.value;
  double best = std::min(at_left.value, at_right.value);
  bool halve = false;
  for (int i = 0; i < 200; ++i) {
    const double width = right - left;
    const double rise = at_right.slope - at_left.slope;  // > 0
    const double meet =
        std::clamp((at_left.value - at_right.value + at_right.slope * width) / rise, 0.0, width);  // from left
    const double bound = at_left.value + at_left.slope * meet;
    if (bound > enough || best - bound <= accuracy || width < 1e-15) return bound > enough ? bound : best;
    const double x = left + (halve ? width / 2 : meet);
    const ValueSlope here = f(x);
    best = std::min(best, here.value);
    if (here.slope == 0) return best;
    (here.slope < 0 ? left : right) = x;
    (here.slope < 0 ? at_left : at_right) = here;
    halve = right - left > width / 2;
  }
  return best;
}

}  // namespace microinjection
