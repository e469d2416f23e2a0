#include "session/session_choices.h"

#include <algorithm>
#include <filesystem>

namespace microinjection {
namespace {

using Names = std::vector<std::string>;

constexpr char kExternal[] = "external";  // a rig of config/rigs

/// The first names, the devices, and the emulated ones.
Names withEmulated(Names first, const Names& devices, const Names& last) {
  first.insert(first.end(), devices.begin(), devices.end());
  for (const std::string& device : devices) first.push_back("emulated_" + device);
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

Names withFirst(const Names& first, const Names& more) { return withEmulated(first, {}, more); }

}  // namespace

SessionChoices::SessionChoices(const std::string& package)
    : models{"auto", "surrogate", "live", "explicit"},
      sensors{"auto", "simulated", "serial", "topic", "none"},
      position_types{"auto", "pose", "transform"},
      controller_forces{"predicted", "measured"},
      hand_forces{"auto", "predicted", "measured", "blend"},
      modes{"auto", "manual", "automatic", "semi_automatic"},
      schemes{"none", "wave"},
      cameras{"none", "sim", "device", "folder", "video", "topic"} {
  Names devices = namesIn(package, "config/rigs");
  // imperfect is a configuration of the simulated rig, and a user's own node has no emulator here.
  const auto is_other = [](const std::string& name) {
    return name == "sim" || name == "imperfect" || name == kExternal;
  };
  devices.erase(std::remove_if(devices.begin(), devices.end(), is_other), devices.end());
  rigs = withEmulated({"sim"}, devices, {kExternal});
  holder_rigs = withFirst({"none"}, rigs);
  const Names pressures = namesIn(package, "config/injectors");
  injectors = withEmulated({"auto", "simulated"}, pressures, {"serial", "none"});
  holders = withEmulated({"none", "sim"}, pressures, {"serial"});
  hands = withFirst({"virtual_hand", "none"}, namesIn(package, "config/haptic"));
  consoles = withFirst({"none"}, namesIn(package, "config/console"));
}

std::vector<std::string> namesIn(const std::string& package, const std::string& below) {
  Names names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(package + "/" + below, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace microinjection
