#pragma once

#include <memory>
#include <string>
#include <vector>

#include "nodes/haptic/haptic_adapter.h"

namespace microinjection {

/// A kind of haptic device. config/haptic/NAME.yaml says which kind a device is.
struct HapticKind {
  std::string name;
  /// A step follows the device's own messages, and the force is handed on as soon as it comes.
  bool paced;
  /// Reads the kind's parameters; errors stay in the reader.
  std::unique_ptr<HapticAdapter> (*make)(Cycle& cycle, ConfigReader& reader);
};

const std::vector<HapticKind>& hapticKinds();
/// @throws ConfigError that names all kinds.
const HapticKind& findHapticKind(const std::string& name);

}  // namespace microinjection
