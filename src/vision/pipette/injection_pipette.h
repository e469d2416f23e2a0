#pragma once

#include "vision/pipette/pipette_axis.h"
#include "vision/pipette/pipette_detection.h"

namespace microinjection {

/// The injection pipette about an axis: where its edges end, then its tip.
/// @param widest  px, diameter of the part that is in the image
PipetteDetection measureInjection(const Frame& frame, const PipetteAxis& axis, double widest);

/// Measures axis and tip again from a place of the tip that is at most `reach` px off.
/// @param rounds  in which the axis and the tip improve each other
PipetteDetection refineInjection(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach,
                                 double widest, int rounds);

}  // namespace microinjection
