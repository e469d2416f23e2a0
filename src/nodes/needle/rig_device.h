#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "base/config_reader.h"
#include "rig/manipulator/manipulator_device.h"
#include "rig/manipulator/manipulator_geometry.h"

namespace microinjection {

/// The device behind the micromanipulator node, and what only a simulated or emulated one has.
struct RigDevice {
  std::unique_ptr<ManipulatorDevice> device;
  /// Has a fault happen (rig/serial/fault.h; besides, with a line, pull:S takes the cable out for S s). Null for a real
  /// device. @throws ConfigError when there is no such fault.
  std::function<void(const std::string& fault, double time)> inject;
  /// Where the tip truly is, as positions (m) of the joints; null where only the device's own reading is known.
  std::function<Eigen::Vector3d()> true_joints;
  /// To be called at each step before the device's, `time` in s; null where nothing is to do.
  std::function<void(double time)> before_step;
};

/// @param name      sim, or a name of rig/devices/rig_registry.h
/// @param emulated  puts the driver on an emulated device in this process, in the node's own time
/// @param reader    the device's own keys; finish() is called. @throws ConfigError
/// @param emulator  of an emulated one: `latency` (s, of the serial adapter: all answers come later by that), and what
///                  its emulator's configure() reads
RigDevice makeRigDevice(const std::string& name, bool emulated, const ManipulatorGeometry& geometry,
                        ConfigReader reader, ConfigReader emulator);

}  // namespace microinjection
