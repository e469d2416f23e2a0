#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "rig/devices/manipulator_emulator.h"
#include "rig/manipulator/manipulator_device.h"
#include "rig/serial/serial_port.h"

namespace microinjection {

/// A device as the rest of the suite knows it. Its configuration is config/rigs/NAME.yaml, with the serial line in
/// `port`. To add one: a folder, and a line in rig_registry.cpp.
struct Rig {
  std::string name;
  int default_baud;  ///< bit/s, of the device as delivered

  /// Reads the device's keys from `reader` (all of them, and calls finish(): ConfigError for what is wrong or unknown)
  /// and puts the driver on `wire`; without one on the serial port that the configuration names.
  std::function<std::unique_ptr<ManipulatorDevice>(ConfigReader& reader, std::unique_ptr<Wire> wire)> make_driver;
  std::function<std::shared_ptr<ManipulatorEmulator>()> make_emulator;
};

const std::vector<Rig>& rigs();
/// @throws ConfigError when there is none of that name, saying which there are.
const Rig& findRig(const std::string& name);

}  // namespace microinjection
