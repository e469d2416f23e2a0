#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "benchmark/common/micrographs.h"
#include "vision/detection/proposal.h"

namespace microinjection {

/// A picture of all images with what is found in them, as thumbnails, without a second eye told look and directions;
/// below each its name and the verdicts of cell, diameter, zona, tip and mouth.
cv::Mat contactSheet(const Micrographs& micrographs, const std::shared_ptr<SecondEye>& eye);

}  // namespace microinjection
