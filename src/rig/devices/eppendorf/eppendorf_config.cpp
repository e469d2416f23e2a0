#include "rig/devices/eppendorf/eppendorf_config.h"

namespace microinjection {

EppendorfConfig EppendorfConfig::read(ConfigReader& reader) {
  EppendorfConfig config;
  config.readCommon(reader, 19200, {1e-6, 7.5e-3});
  return config;
}

}  // namespace microinjection
