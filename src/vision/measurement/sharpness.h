#pragma once

#include <opencv2/core.hpp>

#include "vision/frame/frame.h"
#include "vision/layers/cell_detector.h"

namespace microinjection {

/// Where a needle's tip is in an image.
struct TipInImage {
  cv::Point2d tip;       ///< px
  double direction = 0;  ///< rad, from the tip towards the shaft, from x towards y
  int core = 3;          ///< px, half width of the bright core: about 0.3 of the tip's outer radius
};

/// Sharpness of the bright core of a needle just behind its tip, per squared pixel of the frame's
/// noise: mean square of the second derivative across the axis.
///
/// The walls are left out. They absorb and shift the phase, and the phase's fringes change their sign
/// in the focus: with the walls (tipSharpness) the sharpest plane of a tip in bright field is 1.3 um
/// beside its focus. The core has no such fringes. 0 for a window outside of the image.
double coreSharpness(const Frame& frame, const TipInImage& window);

/// Sharpness of a cell's image, per squared pixel of the frame's noise: mean square of the second
/// derivatives of the grey value inside of the ooplasm's border. It is largest in the plane of the
/// granules there. The borders themselves do not show the focus: that of a transparent zona is
/// faintest where it is in focus. 0 for a cell that has no values.
double cellSharpness(const Frame& frame, const CellDetection& cell);

}  // namespace microinjection
