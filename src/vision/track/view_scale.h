#pragma once

#include "vision/track/specimen_view.h"

namespace microinjection {

/// What is seen in a frame, in px of another one that shows the same in `factor` times as many pixels a side.
SpecimenView scaled(SpecimenView view, double factor);

PipetteDetection scaled(PipetteDetection pipette, double factor);

/// What is searched, in px of such a frame.
CellDetectorConfig scaled(CellDetectorConfig config, double factor);
PipetteDetectorConfig scaled(PipetteDetectorConfig config, double factor);

}  // namespace microinjection
