#include "operation/link/link_config.h"

namespace microinjection {

LinkConfig LinkConfig::read(ConfigReader reader) {
  LinkConfig config;
  reader.choice("scheme", config.scheme, {"none", "wave"});
  reader.number("timeout", config.timeout, Range::positive());
  config.wave = WaveConfig::read(reader.section("wave"));
  return config;
}

}  // namespace microinjection
