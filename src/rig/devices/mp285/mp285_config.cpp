#include "rig/devices/mp285/mp285_config.h"

namespace microinjection {

Mp285Config Mp285Config::read(ConfigReader& reader) {
  Mp285Config config;
  config.readCommon(reader, 9600, {1e-6, 6.55e-3}, Range::nonNegative());
  reader.vector("microsteps", config.microsteps, Range::closed(0, 1e-6));
  if (((config.microsteps.array() > 0) && (config.microsteps.array() < 1e-9)).any()) {
    reader.error("microsteps", "each must be 0 (by the device's status) or from 1e-9 to 1e-6 m");
  }
  reader.number("command_pause", config.command_pause, Range::nonNegative());
  reader.number("half_command_time", config.half_command_time, Range::positive());
  return config;
}

}  // namespace microinjection
