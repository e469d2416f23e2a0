#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"
#include "base/errors.h"
#include "hardware/serial/emulator.h"

namespace microinjection {

/// An emulated micromanipulator, with access for tests besides the line.
class ManipulatorEmulator : public DeviceEmulator {
 public:
  /// Error code of every emulator: the device was switched off and on, and counts from 0 at its
  /// present position.
  static constexpr char kReset[] = "RESET";

  virtual Eigen::Vector3d position() const = 0;  ///< m, true position of the device's axes
  virtual int movesBegun() const = 0;            ///< number of moves to a position
  virtual bool moves() const = 0;
  /// Displaces axes at rest (m, of the device's axes), as the device's hand wheel or knob does.
  virtual void shiftByHand(const Eigen::Vector3d& displacement) = 0;
  /// Sets the reported firmware version and its features.
  /// @throws ConfigError if the device reports none, or does not have `version`.
  virtual void setFirmware(const std::string& version) {
    throw ConfigError("firmware = " + version + ": must be left out, this device tells no version");
  }
  /// Reads deviations from the device as delivered. Each emulator has its own keys.
  virtual void configure(ConfigReader& /*reader*/) {}
};

}  // namespace microinjection
