#pragma once

#include <opencv2/core.hpp>

#include "benchmark/common/micrographs.h"

namespace microinjection {

/// A picture of all images with what is found in them, told look and directions (RealSetup::kTold), as thumbnails;
/// below each its name and the verdicts of cell, diameter, zona, tip and mouth.
cv::Mat contactSheet(const Micrographs& micrographs);

}  // namespace microinjection
