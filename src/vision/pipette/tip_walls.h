#pragma once

#include <opencv2/core.hpp>

#include "vision/frame/frame.h"

namespace microinjection {

/// What the walls show just behind an end that was found. The fit of the end does not use it, so that it is a
/// witness of the end.
struct TipWalls {
  double kept = 0;        ///< edges that both walls share near the end, over those farther behind
  double shading = 0;     ///< odd part of the profile across over its even part, rms: 0 for two walls that are alike
  double half_width = 0;  ///< px, of the profile
};

/// @param end        px
/// @param direction  rad, from the end towards the shaft, from x towards y
TipWalls measureTipWalls(const Frame& frame, const cv::Point2d& end, double direction);

}  // namespace microinjection
