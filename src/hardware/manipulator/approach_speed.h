#pragma once

#include <cmath>

namespace microinjection {

/// Largest speed (m/s) for the next `dt` (s) that does not pass a point `distance` (m, >= 0) ahead:
/// v dt + v^2 / (2 a) = distance, with the deceleration a (m/s^2). Applied in each step, it
/// decelerates by at most a, whatever dt is, and ends exactly at the point.
inline double approachSpeed(double distance, double acceleration, double dt) {
  return 2 * distance / (std::sqrt(dt * dt + 2 * distance / acceleration) + dt);
}

}  // namespace microinjection
