#pragma once

#include <string>

#include "hardware/devices/zaber/zaber_emulator.h"

namespace microinjection {

inline ZaberEmulatorConfig withFirmware(const std::string& version) {
  ZaberEmulatorConfig config;
  config.firmware = version;
  return config;
}

}  // namespace microinjection
