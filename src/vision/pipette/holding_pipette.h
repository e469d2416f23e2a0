#pragma once

#include "vision/pipette/pipette_axis.h"
#include "vision/pipette/pipette_detection.h"

namespace microinjection {

/// The holding pipette about an axis: its outline, then its mouth.
/// @param widest  px, diameter
PipetteDetection measureHolding(const Frame& frame, PipetteAxis axis, double widest);

/// Measures axis and mouth again from a place of the mouth that is at most `reach` px off.
/// @param rounds  in which the axis and the mouth improve each other
PipetteDetection refineHolding(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach, int rounds);

}  // namespace microinjection
