#include "hardware/devices/zaber/zaber_settings.h"

#include <utility>

namespace microinjection {

std::string ZaberSettings::command(Name name) {
  static const std::array<std::string, kNames> names{"version",          "limit.min",  "limit.max",    "accel",
                                                     "motion.decelonly", "resolution", "system.serial"};
  return "get " + names[name];
}

std::optional<ZaberSettings::Name> ZaberSettings::missing() const {
  for (int name = 0; name < kNames; ++name) {
    if (!confirmed_[name]) return static_cast<Name>(name);
  }
  return std::nullopt;
}

void ZaberSettings::add(Name name, const std::string& data) {
  if (std::exchange(last_[name], data) != data) return;
  if (name == kVersion) {
    moves_have_speeds_ = zaberMovesHaveSpeeds(data);
    confirmed_[name] = moves_have_speeds_.has_value();
  } else {
    numbers_[name] = zaberWholeNumber(data);
    confirmed_[name] = numbers_[name].has_value();
  }
}

void ZaberSettings::setUnsupported(Name name) { confirmed_[name] = true; }

}  // namespace microinjection
