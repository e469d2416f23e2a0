#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "vision/frame/contrast_mode.h"
#include "vision/microscope/texture.h"
#include "vision/segmentation/working_image.h"

namespace microinjection {

/// A picture to learn from, with the class of each pixel.
struct TrainingImage {
  cv::Mat picture;  ///< CV_8U
  cv::Mat label;    ///< CV_8U, PixelClass, of the same size
  ContrastMode contrast_mode = ContrastMode::kUnknown;
};

/// Label of the pixels of a WorkingImage that lie outside its region: they are not learnt.
constexpr unsigned char kNoLabel = 255;

/// Renders training images. The same seed gives the same image.
class TrainingImages {
 public:
  TrainingImage make(std::uint64_t seed);

 private:
  TrainingImage panel(std::uint64_t seed);

  Texture texture_;
};

/// Label of each output pixel of the network, CV_8U, of half the working image's size: that of the image's pixel at its
/// middle, and kNoLabel outside the region.
cv::Mat workingLabel(const cv::Mat& label, const WorkingImage& working);

}  // namespace microinjection
