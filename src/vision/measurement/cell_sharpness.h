#pragma once

#include "vision/frame/frame.h"
#include "vision/layers/cell_detector.h"

namespace microinjection {

/// Sharpness of a cell's image, per squared pixel of the frame's noise: mean square of the second
/// derivatives of the grey value inside of the ooplasm's border. It is largest in the plane of the
/// granules there. The borders themselves do not show the focus: that of a transparent zona is
/// faintest where it is in focus. 0 for a cell that has no values.
double cellSharpness(const Frame& frame, const CellDetection& cell);

}  // namespace microinjection
