#include "rig/devices/scientifica/scientifica_config.h"

namespace microinjection {

ScientificaConfig ScientificaConfig::read(ConfigReader& reader) {
  ScientificaConfig config;
  config.readCommon(reader, 38400, {1e-6, 3.9e-3});
  reader.integer("version", config.version, Range::closed(2, 3));
  reader.number("acceleration", config.acceleration, Range::closed(0.0005, 0.039));
  const double least = config.speed / config.segment_time;
  if (config.acceleration < least) {
    reader.error("acceleration", "must be at least speed / segment_time = " + std::to_string(least) +
                                     " m/s^2: a short move would end before it has its speed");
  }
  return config;
}

}  // namespace microinjection
