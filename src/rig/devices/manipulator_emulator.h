#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"
#include "base/errors.h"
#include "rig/serial/emulator.h"

namespace microinjection {

/// An emulated micromanipulator: what a test may look at without asking over the line.
class ManipulatorEmulator : public DeviceEmulator {
 public:
  /// The code of an "error" that each of them knows: it was switched off and on, and counts from 0 where it stands.
  static constexpr char kReset[] = "RESET";

  virtual Eigen::Vector3d position() const = 0;  ///< m, of the device's axes, as they are
  virtual int movesBegun() const = 0;            ///< moves to a place that it has begun
  virtual bool moves() const = 0;
  /// Puts axes at rest elsewhere (m, of the device's axes), as its own hand wheel or knob does.
  virtual void shiftByHand(const Eigen::Vector3d& way) = 0;
  /// The version that it tells, and what it can do with it.
  /// @throws ConfigError when the device tells none, or when `version` is none of its versions.
  virtual void setFirmware(const std::string& version) {
    throw ConfigError("firmware = " + version + ": must be left out, this device tells no version");
  }
  /// Reads what the device is like beside what it is as delivered; its keys are in the device's emulator.
  virtual void configure(ConfigReader& /*reader*/) {}
};

}  // namespace microinjection
