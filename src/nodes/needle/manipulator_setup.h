#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "base/config_reader.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// The device of the micromanipulator node, with extras of simulated and emulated ones.
struct ManipulatorSetup {
  std::unique_ptr<ManipulatorDevice> device;
  /// Injects a fault (hardware/serial/fault.h; with a serial line also pull:S, which disconnects the
  /// cable for S s). Null for a real device. @throws ConfigError when there is no such fault.
  std::function<void(const std::string& fault, double time)> inject;
  /// True positions (m) of the joints; null when only the device's own reading is known.
  std::function<Eigen::Vector3d()> true_joints;
  /// Call before each step of the device, `time` in s; may be null.
  std::function<void(double time)> before_step;
  /// Fills in the device's own status for the diagnostics; may be null.
  std::function<void(diagnostic_updater::DiagnosticStatusWrapper& status)> report;
  bool moves_in_real_time = false;  ///< a real device on a line, which moves on while virtual time stands
};

/// @param name      sim, external, or a name of hardware/devices/driver_registry.h
/// @param cycle     of the node, with the topics of an external device
/// @param emulated  connects the driver to an emulated device in this process, in the node's time
/// @param reader    the device's own keys; finish() is called. @throws ConfigError
/// @param emulator  for an emulated device: `latency` (s, of the serial adapter, delays all
///                  replies), and the keys of its emulator's configure()
ManipulatorSetup makeManipulatorSetup(const std::string& name, bool emulated, const ManipulatorGeometry& geometry,
                                      Cycle& cycle, ConfigReader reader, ConfigReader emulator);

}  // namespace microinjection
