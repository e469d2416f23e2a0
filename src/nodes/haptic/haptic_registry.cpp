#include "nodes/haptic/haptic_registry.h"

#include "base/errors.h"
#include "nodes/haptic/crtk_adapter.h"
#include "nodes/haptic/geomagic_adapter.h"
#include "nodes/haptic/joy_adapter.h"
#include "nodes/haptic/keyboard_adapter.h"
#include "nodes/haptic/marker_adapter.h"
#include "nodes/haptic/omni_adapter.h"

namespace microinjection {
namespace {

template <typename Adapter>
std::unique_ptr<HapticAdapter> make(Cycle& cycle, ConfigReader& reader) {
  const typename Adapter::Config config = Adapter::Config::read(reader);
  reader.finish();
  return std::make_unique<Adapter>(cycle, config);
}

}  // namespace

const std::vector<HapticKind>& hapticKinds() {
  static const std::vector<HapticKind> all{
      {"crtk", true, make<CrtkAdapter>},          {"omni", true, make<OmniAdapter>},
      {"geomagic", true, make<GeomagicAdapter>},  {"joy", false, make<JoyAdapter>},
      {"keyboard", false, make<KeyboardAdapter>}, {"marker", false, make<MarkerAdapter>},
  };
  return all;
}

const HapticKind& findHapticKind(const std::string& name) {
  std::string names;
  for (const HapticKind& kind : hapticKinds()) {
    if (kind.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw ConfigError("kind = " + name + ": must be one of: " + names);
}

}  // namespace microinjection
