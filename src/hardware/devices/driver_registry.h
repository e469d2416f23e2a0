#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "hardware/devices/manipulator_emulator.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {

/// Registered device. Its configuration is config/rigs/NAME.yaml, with the serial line in `port`.
/// To add one, add a folder and a line in driver_registry.cpp.
struct DriverEntry {
  std::string name;
  int default_baud;  ///< bit/s, as delivered

  /// Reads all of the device's keys from `reader`, calls finish(), and makes the driver on `wire`,
  /// or without a wire on the configured serial port. Throws ConfigError for invalid or unknown
  /// keys.
  std::function<std::unique_ptr<ManipulatorDevice>(ConfigReader& reader, std::unique_ptr<Wire> wire)> make_driver;
  std::function<std::shared_ptr<ManipulatorEmulator>()> make_emulator;
};

const std::vector<DriverEntry>& driverEntries();
/// @throws ConfigError for an unknown name, with the known ones.
const DriverEntry& findDriver(const std::string& name);

}  // namespace microinjection
