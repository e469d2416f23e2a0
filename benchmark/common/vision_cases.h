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

/// Rows of the real micrographs, nothing without their folder. real_tune and real_held are every second
/// file of each source in the order of its readings. Both were looked at while the constants were
/// chosen, so neither is independent: only images that nobody here has seen are.
void realRows(const TakeRow& take);

}  // namespace microinjection
