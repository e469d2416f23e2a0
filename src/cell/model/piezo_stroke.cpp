#include "cell/model/piezo_stroke.h"

#include <cmath>

namespace microinjection {

double StrokeResistance::largestForce(const PiezoPulse& pulse) const {
  // With p = pi t / rise_time it is elastic + (inertia - elastic) cos p + drag sin p.
  const double half = pulse.amplitude / 2, pace = M_PI / pulse.rise_time;
  const double elastic = stiffness * half, drag = 8 * viscosity * tip_radius * half * pace;
  const double inertia = 4.0 / 3 * kDensity * std::pow(tip_radius, 3) * half * pace * pace;
  return elastic + std::hypot(inertia - elastic, drag);
}

}  // namespace microinjection
