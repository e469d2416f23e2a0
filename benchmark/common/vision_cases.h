#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/common/vision_row.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/microscope_config.h"
#include "vision/microscope/scene_draw.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// How images are drawn and rendered.
struct VisionCondition {
  std::string name;
  SceneDrawConfig draw;
  MicroscopeConfig microscope;
  double focus = 0;  ///< m, of the plane in focus
};

std::vector<VisionCondition> visionConditions();

/// An image with its truth.
struct RenderedImage {
  cv::Mat image;
  SceneTruth truth;
};

/// @param microscope  of the condition
RenderedImage renderedImage(const VisionCondition& condition, Microscope& microscope, std::uint64_t seed);

/// What the condition's images are searched with: look, diameters and directions are told.
SpecimenTrackerConfig trackerConfig(const VisionCondition& condition);

/// Rows of `images` rendered images, with the seeds from `first` on. The constants were chosen with seeds
/// below 100000.
/// @param eye  none: geometry alone
/// @param pipettes_only  cells and dimples are not measured, which takes most of the time
void renderedRows(const VisionCondition& condition, std::uint64_t first, int images, bool pipettes_only,
                  const std::shared_ptr<SecondEye>& eye, const TakeRow& take);

}  // namespace microinjection
