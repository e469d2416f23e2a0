#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// State of the hand at a device.
struct HandReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the device's axes
  ros::Time stamp;                                     ///< of the measurement
  bool clutch = false;                                 ///< pressed
  bool operator_present = true;
};

/// Adapter of a device with its own driver's topics, or without a driver. The constructor
/// subscribes and advertises; see haptic_registry.h.
class HapticAdapter {
 public:
  virtual ~HapticAdapter() = default;

  /// The present hand; empty while the device is stale or invalid.
  virtual std::optional<HandReading> read(const Cycle::Tick& tick) = 0;
  /// Renders the force on the hand (N, the device's axes). Called in every step, with zero for no
  /// force, since drivers hold the last force for ever.
  virtual void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) = 0;
  /// The operator's commands for /controller/state_command since the last call.
  virtual std::vector<std::string> takeCommands() { return {}; }
  /// Why there is no hand although the device is not stale; else empty.
  virtual std::string invalidReason() const { return ""; }
  /// Whether the operator requested the end of the program.
  virtual bool wantsToEnd() const { return false; }
};

}  // namespace microinjection
