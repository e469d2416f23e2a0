#include "operation/display/display_config.h"

#include "operation/display/surface_quantity.h"

namespace microinjection {

DisplayConfig DisplayConfig::read(ConfigReader& reader) {
  DisplayConfig config;
  reader.number("rate", config.rate, {0, 60, true, false});
  reader.number("enlargement", config.enlargement, Range::positive());
  reader.boolean("edges", config.edges);
  reader.choice("colour", config.colour, surfaceQuantities());
  reader.number("colour_range", config.colour_range, Range::nonNegative());
  reader.number("stress_range", config.stress_range, Range::nonNegative());
  reader.boolean("section", config.section);
  reader.number("trail", config.trail, Range::closed(0, 600));
  reader.number("force_scale", config.force_scale, Range::positive());
  ConfigReader injection_pipette = reader.section("injection_pipette");
  config.injection_pipette = DrawnInjectionPipette::read(injection_pipette);
  ConfigReader holding_pipette = reader.section("holding_pipette");
  config.holding_pipette = DrawnHoldingPipette::read(holding_pipette);
  return config;
}

}  // namespace microinjection
