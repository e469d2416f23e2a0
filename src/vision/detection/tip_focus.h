#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/detection/finding.h"
#include "vision/detection/frame.h"

namespace microinjection {

/// Sharpness of the image of a tip, per squared pixel of the frame's noise: mean square of the
/// second derivatives along and across the axis, in a window behind the tip. A window of the tip only:
/// a frame-wide measure has its peak on the sharpest dust. 0 for a window outside of the image.
/// @param tip        px
/// @param direction  rad, from the tip towards the shaft, from x towards y
/// @param length     px, of the window along the axis
double tipSharpness(const Frame& frame, const cv::Point2d& tip, double direction, double length = 24);

struct BestFocus {
  Finding finding;
  double plane = 0;      ///< index of the plane, with fractions
  double deviation = 0;  ///< planes, standard deviation
};

/// The plane of the highest sharpness, between the planes by a parabola through the logarithms of the
/// highest and its neighbours. Uncertain when the peak is at an end of the stack, not found when
/// nothing in the stack is sharper than the rest.
BestFocus bestFocus(const std::vector<double>& sharpness);

}  // namespace microinjection
