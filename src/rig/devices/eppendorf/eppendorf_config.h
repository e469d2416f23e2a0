#pragma once

#include "rig/devices/polled_manipulator.h"

namespace microinjection {

struct EppendorfConfig : PolledManipulatorConfig {
  EppendorfConfig() { port.baud = 19200; }

  static EppendorfConfig read(ConfigReader& reader);
};

}  // namespace microinjection
