#pragma once

#include <opencv2/core.hpp>

#include "vision/frame/frame.h"

namespace microinjection {

/// Sharpness of the image of a tip: mean square of the second derivatives along and across the axis, in
/// a window behind the tip, over its squared mean brightness. The noise of an 8-bit frame is no measure
/// to divide by: it jumps from plane to plane. It is the sharpness that
/// a search of the focus takes (calibration's findFocus). The window has the tip only: a measure of
/// the whole frame has its peak on the sharpest dust. 0 for a window outside of the image.
/// @param tip        px
/// @param direction  rad, from the tip towards the shaft, from x towards y
/// @param length     px, of the window along the axis
double tipSharpness(const Frame& frame, const cv::Point2d& tip, double direction, double length = 24);

}  // namespace microinjection
