#include "vision/calibration/calibration_config.h"

namespace microinjection {

CalibrationConfig CalibrationConfig::read(ConfigReader& reader) {
  CalibrationConfig config;
  ConfigReader pattern = reader.section("pattern"), limits = reader.section("limits"), drift = reader.section("drift");
  ConfigReader touch = reader.section("touch"), focus = reader.section("focus");
  config.pattern = CalibrationPatternConfig::read(pattern);
  config.limits = CalibrationLimits::read(limits);
  config.drift = DriftWatchConfig::read(drift);
  config.touch = TouchByVisionConfig::read(touch);
  config.focus = TipFocusConfig::read(focus);
  if (config.pattern.take_up <= config.limits.largest_backlash) {
    pattern.error("take_up", "must be above limits/largest_backlash, or the play is not taken up");
  }
  return config;
}

}  // namespace microinjection
