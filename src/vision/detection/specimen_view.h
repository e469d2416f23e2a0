#pragma once

#include "base/config_reader.h"
#include "vision/detection/cell_detector.h"
#include "vision/detection/indentation_contour.h"
#include "vision/detection/overlay.h"
#include "vision/detection/pipette_detector.h"

namespace microinjection {

struct SpecimenTrackerConfig {
  double reach = 40;  ///< px, largest motion from one frame to the next
  CellDetectorConfig cell;
  PipetteDetectorConfig injection, holding;

  /// Reads reach and the sections cell, injection_pipette and holding_pipette.
  static SpecimenTrackerConfig read(ConfigReader& reader);
};

/// What one frame shows.
struct SpecimenView {
  CellDetection cell;
  PipetteDetection injection, holding;
  Dimple indentation;

  OverlayContent overlay() const { return {&cell, &holding, &injection, &indentation}; }
};

}  // namespace microinjection
