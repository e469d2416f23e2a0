#include "cell/model/aspirated_membrane.h"

#include <cmath>

#include "cell/model/read_quantity.h"

namespace microinjection {

const std::vector<std::string>& AspirationConfig::modes() {
  static const std::vector<std::string> modes = {"at", "during", "after", "none"};
  return modes;
}

AspirationConfig AspirationConfig::read(ConfigReader reader) {
  AspirationConfig config;
  config.mode.clear();  // empty unless it is read
  reader.choice("mode", config.mode, modes(), ConfigReader::kRequired);
  const bool by_tension = config.mode == "during" || config.mode == "after";
  const auto required = by_tension ? ConfigReader::kRequired : ConfigReader::kOptional;
  readQuantity(reader, "tension", config.tension, Range::positive(), "N/m", required);
  readQuantity(reader, "tension_scale", config.tension_scale, Range::positive(), "N/m");
  readQuantity(reader, "tension_time", config.tension_time, Range::positive(), "s");
  readQuantity(reader, "weakened", config.weakened, Range::closed(0, 1), "");
  for (const char* key : {"tension", "tension_scale", "tension_time"}) {
    if (!by_tension && reader.has(key)) reader.error(key, "must be left out: it belongs to modes during and after");
  }
  if (reader.has("tension_time") && !reader.has("tension_scale"))
    reader.error("tension_time", "must be left out without tension_scale: the membrane then breaks at once");
  if (config.mode != "after" && reader.has("weakened"))
    reader.error("weakened", "must be left out: it belongs to mode after");
  return config;
}

void AspirationConfig::check(const std::string& path, ConfigErrors& errors) const {
  errors.requireOneOf(modes(), path + "mode", mode);
  errors.require(Range::positive(), path + "tension", tension, " N/m");
  errors.require(Range::nonNegative(), path + "tension_scale", tension_scale, " N/m");
  errors.require(Range::positive(), path + "tension_time", tension_time, " s");
  errors.require(Range::closed(0, 1), path + "weakened", weakened);
}

bool AspiratedMembrane::step(double tension, double dt) {
  constexpr double kOver = 0.1;  // of the tension that weakens it
  over_ = tension < kOver * config_.tension;
  if (tension <= 0 || config_.mode == "none") return false;
  if (config_.mode == "at") return true;
  if (config_.tension_scale > 0) {
    spent_ += dt / config_.tension_time * std::exp((tension - config_.tension) / config_.tension_scale);
  } else if (tension >= config_.tension) {
    spent_ = 1;
  }
  return config_.mode == "during" && spent_ >= 1;
}

}  // namespace microinjection
