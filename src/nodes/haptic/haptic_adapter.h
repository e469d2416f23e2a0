#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// What a device tells of the hand.
struct HandReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the device's axes
  ros::Time stamp;                                     ///< of the measurement
  bool clutch = false;                                 ///< pressed
  bool operator_present = true;
};

/// A device behind the topics of its own driver, or one that has none. Its constructor has subscribed and advertised;
/// see haptic_registry.h.
class HapticAdapter {
 public:
  virtual ~HapticAdapter() = default;

  /// The hand now; empty while the device is silent or tells nonsense.
  virtual std::optional<HandReading> read(const Cycle::Tick& tick) = 0;
  /// Called in every step with the force on the hand (N, the device's axes), zero where none is to be felt. Drivers
  /// that hold the last force for ever get it again and again.
  virtual void render(const Eigen::Vector3d& force, const Cycle::Tick& tick) = 0;
  /// The operator's words for /controller/state_command since the last call.
  virtual std::vector<std::string> takeCommands() { return {}; }
  /// Why there is no hand although the device is not silent; empty: it is, or there is a hand.
  virtual std::string whySilent() const { return ""; }
  /// The operator wants to end the program.
  virtual bool wantsToEnd() const { return false; }
};

}  // namespace microinjection
