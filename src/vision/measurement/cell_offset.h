#pragma once

#include <optional>

#include "vision/layers/cell_detector.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {

/// Where a cell lies beside the axis of the holding pipette, px.
struct CellOffset {
  double lateral = 0;    ///< positive to the right of the axis, seen from the shaft to the mouth
  double deviation = 0;  ///< standard deviation: of the centre, of the mouth and of the axis' direction
};

/// None when the cell or the pipette was not found, or is uncertain.
std::optional<CellOffset> cellOffset(const CellDetection& cell, const PipetteDetection& holding);

}  // namespace microinjection
