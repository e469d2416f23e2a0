#pragma once

#include <cmath>

namespace microinjection {

/// Largest speed (m/s) to go on with for the next `dt` (s) so as not to go past a point `distance` (m, >= 0) ahead:
/// v dt + v^2 / (2 a) = distance, with the deceleration a (m/s^2). Going on with it, step by step, brakes with a at the
/// most, whatever dt is each time, and ends exactly there.
inline double approachSpeed(double distance, double acceleration, double dt) {
  return 2 * distance / (std::sqrt(dt * dt + 2 * distance / acceleration) + dt);
}

}  // namespace microinjection
