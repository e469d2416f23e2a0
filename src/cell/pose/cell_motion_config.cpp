#include "cell/pose/cell_motion_config.h"

#include <cmath>

namespace microinjection {
namespace {

/// Calls field(key, value, range, unit) for each field.
template <typename Config, typename Field>
void visitMotionFields(Config& config, const Field& field) {
  field("radius", config.radius, Range::positive(), " m");
  field("density_difference", config.density_difference, Range{}, " kg/m^3");
  field("gravity", config.gravity, Range::nonNegative(), " m/s^2");
  field("viscosity", config.viscosity, Range::positive(), " Pa s");
  field("modulus", config.modulus, Range::positive(), " Pa");
  field("poisson_ratio", config.poisson_ratio, Range::closed(0, 0.5), "");
  field("roughness", config.roughness, Range::positive(), " m");
  field("dish_height", config.dish_height, Range{}, " m");
  field("friction/lip", config.friction.lip, Range::nonNegative(), "");
  field("friction/dish", config.friction.dish, Range::nonNegative(), "");
  field("friction/needle", config.friction.needle, Range::nonNegative(), "");
  field("creep_speed", config.creep_speed, Range::positive(), " m/s");
  field("bore_length", config.bore_length, Range::nonNegative(), " m");
  field("lost_distance", config.lost_distance, Range::positive(), " m");
}

}  // namespace

double CellMotionConfig::contactModulus() const { return modulus / (1 - poisson_ratio * poisson_ratio); }

double CellMotionConfig::weight() const {
  return 4 * M_PI / 3 * radius * radius * radius * density_difference * gravity;
}

double CellMotionConfig::drag() const { return 6 * M_PI * viscosity * radius; }

void CellMotionConfig::read(ConfigReader reader) {
  ConfigReader coefficients = reader.section("friction");
  visitMotionFields(*this, [&](const std::string& key, double& value, const Range& range, const char*) {
    if (key == "radius") return;  // the cell's
    const std::size_t slash = key.find('/');
    ConfigReader& from = slash == std::string::npos ? reader : coefficients;
    from.number(slash == std::string::npos ? key : key.substr(slash + 1), value, range);
  });
}

void CellMotionConfig::validate() const {
  ConfigErrors errors("cell motion");
  visitMotionFields(*this, [&](const std::string& key, double value, const Range& range, const char* unit) {
    errors.require(range, key, value, unit);
  });
  errors.require(!(radius > 0) || roughness < radius, "roughness", roughness, " m", "below the radius");
  errors.throwAny();
}

}  // namespace microinjection
