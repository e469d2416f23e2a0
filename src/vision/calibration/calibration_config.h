#pragma once

#include "base/config_reader.h"
#include "vision/calibration/calibration_limits.h"
#include "vision/calibration/calibration_pattern.h"
#include "vision/calibration/drift_watch.h"
#include "vision/calibration/tip_focus.h"
#include "vision/calibration/touch_by_vision.h"

namespace microinjection {

/// The parameters of this room, a section each: config/calibration.yaml.
struct CalibrationConfig {
  CalibrationPatternConfig pattern;
  CalibrationLimits limits;
  DriftWatchConfig drift;
  TouchByVisionConfig touch;
  TipFocusConfig focus;

  static CalibrationConfig read(ConfigReader& reader);
};

}  // namespace microinjection
