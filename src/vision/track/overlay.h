#pragma once

#include <opencv2/core.hpp>

#include "vision/dimple/indentation_contour.h"
#include "vision/layers/cell_detector.h"
#include "vision/pipette/bore_border.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {

/// What was found in a frame, for drawing. Null pointers are left out.
struct OverlayContent {
  const CellDetection* cell = nullptr;
  const PipetteDetection* holding = nullptr;
  const PipetteDetection* injection = nullptr;
  const Dimple* indentation = nullptr;
  const BoreBorder *column = nullptr, *tongue = nullptr;  ///< in the injection and in the holding pipette
};

/// Draws what was found on the frame with thin lines, values in px, and the verdicts with their
/// reasons. Dashed: uncertain. Returns CV_8UC3 of the frame's size; a frame that is refused gives a
/// black picture with the reason.
cv::Mat drawOverlay(const Frame& frame, const OverlayContent& content);

}  // namespace microinjection
