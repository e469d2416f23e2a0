#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "benchmark/common/micrographs.h"
#include "vision/track/specimen_tracker.h"

namespace microinjection {

/// An image of a contact sheet.
struct SheetImage {
  std::string name;
  cv::Mat image;
  SpecimenTrackerConfig config;
};

/// The real images; without a second eye told look and directions.
std::vector<SheetImage> realSheet(const Micrographs& micrographs, bool second_eye);

/// Rendered images, two of each condition with the seeds from `first` on.
std::vector<SheetImage> renderedSheet(std::uint64_t first);

/// A picture of images with what is found in them, as thumbnails; below each its name and the verdicts of cell,
/// diameter, zona, tip and mouth.
cv::Mat contactSheet(const std::vector<SheetImage>& images, const std::shared_ptr<SecondEye>& eye);

}  // namespace microinjection
