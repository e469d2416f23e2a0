#pragma once

#include "rig/devices/polled_manipulator.h"

namespace microinjection {

struct ScientificaConfig : PolledManipulatorConfig {
  ScientificaConfig() {
    port.baud = 38400;
    reply_timeout = 0.35;
  }

  int version = 3;             ///< of the motion card: 2 or 3; others are refused
  double acceleration = 0.03;  ///< m/s^2, set in the device at the start

  static ScientificaConfig read(ConfigReader& reader);
};

}  // namespace microinjection
