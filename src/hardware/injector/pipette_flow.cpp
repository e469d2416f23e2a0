#include "hardware/injector/pipette_flow.h"

#include <cmath>

namespace microinjection {

PipetteConfig PipetteConfig::read(ConfigReader& reader) {
  PipetteConfig config;
  reader.number("tip_radius", config.tip_radius, Range::positive());
  reader.number("tip_length", config.tip_length, Range::nonNegative());
  reader.number("shaft_radius", config.shaft_radius, Range::positive());
  reader.number("taper_length", config.taper_length, Range::nonNegative());
  reader.number("shaft_length", config.shaft_length, Range::nonNegative());
  reader.number("viscosity", config.viscosity, Range::positive());
  reader.number("surface_tension", config.surface_tension, Range::nonNegative());
  reader.number("contact_angle", config.contact_angle, Range::closed(0, M_PI));
  reader.number("meniscus_radius", config.meniscus_radius, Range::positive());
  reader.number("outside_pressure", config.outside_pressure);
  if (config.tip_radius > config.shaft_radius) reader.error("tip_radius", "must not be above shaft_radius");
  if (config.tip_length + config.taper_length + config.shaft_length <= 0)
    reader.error("tip_length", "no pipette is left");
  return config;
}

double interfaceDepth(const PipetteConfig& config, double drawn) {
  const double tip = config.tip_radius, shaft = config.shaft_radius;
  const double of_end = M_PI * tip * tip * config.tip_length;
  if (drawn <= of_end) return drawn / (M_PI * tip * tip);
  const double beyond = drawn - of_end;
  const double of_cone = M_PI / 3 * config.taper_length * (tip * tip + tip * shaft + shaft * shaft);
  if (beyond > of_cone) return config.tip_length + config.taper_length + (beyond - of_cone) / (M_PI * shaft * shaft);
  const double slope = (shaft - tip) / config.taper_length;
  // The cone's volume is pi (r^3 - tip^3) / (3 slope); in a nearly straight one that difference would be lost.
  if (slope < 1e-9) return config.tip_length + beyond / (M_PI * tip * tip);
  const double radius = std::cbrt(tip * tip * tip + 3 * slope * beyond / M_PI);
  return config.tip_length + (radius - tip) / slope;
}

double coneResistanceIntegral(double from_radius, double to_radius, double length) {
  // With r linear in z: (r1^-3 - r2^-3) / (3 slope), without the division by a slope that may be
  // zero.
  const double a = from_radius, b = to_radius, product = a * b;
  return length * (a * a + product + b * b) / (3 * product * product * product);
}

PipetteFlow::PipetteFlow(const PipetteConfig& config)
    : rest_(2 * config.surface_tension * std::cos(config.contact_angle) / config.meniscus_radius +
            config.outside_pressure) {
  const double integral = coneResistanceIntegral(config.tip_radius, config.tip_radius, config.tip_length) +
                          coneResistanceIntegral(config.tip_radius, config.shaft_radius, config.taper_length) +
                          coneResistanceIntegral(config.shaft_radius, config.shaft_radius, config.shaft_length);
  resistance_ = 8 * config.viscosity / M_PI * integral;
}

}  // namespace microinjection
