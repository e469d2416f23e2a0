#pragma once

#include <string>
#include <vector>

#include "benchmark/common/vision_row.h"
#include "vision/microscope/microscope_config.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {

/// How images are drawn and rendered.
struct VisionCondition {
  std::string name;
  SceneDrawConfig draw;
  MicroscopeConfig microscope;
  double focus = 0;  ///< m, of the plane in focus
};

std::vector<VisionCondition> visionConditions();

/// Rows of `images` rendered images.
void renderedRows(const VisionCondition& condition, int images, const TakeRow& take);

}  // namespace microinjection
