#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// The value of a key whose default follows from other keys, or from a file.
inline constexpr char kAuto[] = "auto";

/// The allowed values of the keys of a session. Devices are those that have a file in the package.
struct SessionChoices {
  std::vector<std::string> models, rigs, holder_rigs, sensors, injectors, holders, hands, position_types,
      controller_forces, hand_forces, modes, schemes, cameras, consoles;

  explicit SessionChoices(const std::string& package);
};

/// The names of package/`below`/NAME.yaml, in order.
std::vector<std::string> namesIn(const std::string& package, const std::string& below);

}  // namespace microinjection
