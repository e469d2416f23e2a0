#include "vision/track/specimen_view.h"

#include <cmath>

namespace microinjection {
namespace {

PipetteDetectorConfig readPipette(ConfigReader& reader, const std::string& kind, double direction) {
  PipetteDetectorConfig config = PipetteDetectorConfig::read(reader);
  config.any_direction = !reader.has("direction");
  if (config.any_direction) config.direction = direction;
  config.kind = kind;
  return config;
}

}  // namespace

SpecimenTrackerConfig SpecimenTrackerConfig::read(ConfigReader& reader) {
  SpecimenTrackerConfig config;
  reader.number("reach", config.reach, Range::closed(2, 500));
  ConfigReader cell = reader.section("cell");
  config.cell = CellDetectorConfig::read(cell);
  ConfigReader injection = reader.section("injection_pipette"), holding = reader.section("holding_pipette");
  config.injection = readPipette(injection, "injection", -M_PI / 2);
  config.holding = readPipette(holding, "holding", M_PI / 2);
  return config;
}

}  // namespace microinjection
