#pragma once

#include "vision/layers/cell_detector.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {

/// Whether a cell is at the holding pipette's mouth. Found: `held` is sure, either way.
struct HoldDetection {
  Finding finding;
  bool held = false;     ///< the cell's outline reaches the mouth
  double gap = 0;        ///< px along the pipette's axis, from the mouth to the outline; negative: it is in the mouth
  double deviation = 0;  ///< px, standard deviation of the gap
};

/// By the ellipse of the cell's outer border, which a tongue and a dimple leave as it is. A cell that the image does
/// not show is neither held nor lost.
HoldDetection detectHold(const CellDetection& cell, const PipetteDetection& holding);

}  // namespace microinjection
