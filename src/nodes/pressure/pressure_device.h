#pragma once

#include <std_msgs/Header.h>

#include <memory>
#include <string>

#include "hardware/injector/injector_protocol.h"
#include "hardware/serial/serial_port.h"
#include "hardware/serial/wire.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// The device behind a pressure line, of injector or holder: a model, or one on a serial line that speaks a protocol of
/// config/injectors.
struct PressureDevice {
  std::string source = "simulated";  ///< or serial
  SerialPortConfig port;
  InjectorProtocol protocol;
  std::string emulated = "none";  ///< or a name of config/injectors: its emulator replaces the port

  /// Reads source, serial and emulated.
  static PressureDevice read(ConfigReader& reader);
  bool isSerial() const { return source == "serial"; }
  /// @throws ConfigError for a real port in virtual time
  std::unique_ptr<Wire> makeWire(const Bus& bus) const;
};

/// Why a command of a pressure is too old, or ahead, by more than `timeout` (s), or has no stamp; empty: it is timely.
std::string pressureStampError(const std_msgs::Header& header, const ros::Time& now, double timeout);

}  // namespace microinjection
