#pragma once

#include "base/config_reader.h"
#include "vision/dimple/indentation_contour.h"
#include "vision/layers/cell_detector.h"
#include "vision/pipette/bore_border.h"
#include "vision/pipette/pipette_detector.h"
#include "vision/track/hold_detection.h"
#include "vision/track/overlay.h"

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
  BoreBorder column, tongue;  ///< in the injection and in the holding pipette
  HoldDetection hold;

  OverlayContent overlay() const { return {&cell, &holding, &injection, &indentation, &column, &tongue}; }
};

}  // namespace microinjection
