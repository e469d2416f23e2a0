#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "vision/microscope/microscope_config.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {

/// One measured thing in one image.
struct VisionRow {
  std::string set, image, what;
  double error = std::numeric_limits<double>::quiet_NaN();     ///< px; planes of focus, degrees of an axis
  double relative = std::numeric_limits<double>::quiet_NaN();  ///< of the truth
  bool found = false;
  bool wrong = false;  ///< found without a warning, and not so
  std::string verdict{};
  double time = std::numeric_limits<double>::quiet_NaN();  ///< s of processor time
};

/// An error above this many times the goal is wrong, not merely inexact.
constexpr double kWrongFactor = 10;

/// How images are drawn and rendered.
struct VisionCondition {
  std::string name;
  SceneDrawConfig draw;
  MicroscopeConfig microscope;
  double focus = 0;  ///< m, of the plane in focus
};

std::vector<VisionCondition> visionConditions();

using TakeRow = std::function<void(const VisionRow&)>;

/// Rows of `images` rendered images.
void renderedRows(const VisionCondition& condition, int images, const TakeRow& take);

/// Rows of the real micrographs, sets real_tune and real_held: every second file of each source, by
/// the order of the readings below, was used to choose the constants. Nothing without the folder.
void realRows(const TakeRow& take);

}  // namespace microinjection
