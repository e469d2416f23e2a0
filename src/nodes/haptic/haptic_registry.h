#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/haptic/haptic_adapter.h"

namespace microinjection {

/// A kind of haptic device. config/haptic/NAME.yaml sets the kind of a device.
struct HapticKind {
  std::string name;
  /// Whether the device's messages trigger the steps and the force is rendered on arrival.
  bool paced;
  /// Reads the kind's parameters; errors stay in the reader.
  std::unique_ptr<HapticAdapter> (*make)(Cycle& cycle, ConfigReader& reader);
};

const std::vector<HapticKind>& hapticKinds();
/// @throws ConfigError with the names of all kinds.
const HapticKind& findHapticKind(const std::string& name);

}  // namespace microinjection
