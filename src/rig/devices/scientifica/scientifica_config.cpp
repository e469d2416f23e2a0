#include "rig/devices/scientifica/scientifica_config.h"

namespace microinjection {

ScientificaConfig ScientificaConfig::read(ConfigReader& reader) {
  ScientificaConfig config;
  config.readCommon(reader, 38400, {1e-6, 3.9e-3});
  reader.integer("version", config.version, Range::closed(2, 3));
  reader.number("acceleration", config.acceleration, Range::closed(0.0005, 0.039));
  return config;
}

}  // namespace microinjection
