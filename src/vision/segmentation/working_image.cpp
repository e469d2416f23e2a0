#include "vision/segmentation/working_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace microinjection {
namespace {

constexpr double kTail = 0.005;        // of the pixels, beyond each percentile
constexpr double kLeastSpan = 1e-6;    // of the levels: below it an image is one grey
constexpr int kNeighbourhood = 41;     // px, side of the square whose mean and spread are taken
constexpr double kSpreadFloor = 0.02;  // of the span, so that noise alone does not fill the second plane
constexpr double kLocalUnit = 1.5;     // spreads

float quantile(std::vector<float>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

cv::Mat asLevels(const cv::Mat& relative) {
  cv::Mat levels;
  relative.convertTo(levels, CV_8U, WorkingImage::kLevelsPerUnit, WorkingImage::kLevelOfZero);
  return levels;
}

/// Relative to the mean and the spread of the neighbourhood. `grey` has its span as unit.
cv::Mat localContrast(const cv::Mat& grey) {
  const cv::Size window(kNeighbourhood, kNeighbourhood);
  cv::Mat mean, difference, variance;
  cv::boxFilter(grey, mean, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REFLECT_101);
  difference = grey - mean;
  cv::boxFilter(difference.mul(difference), variance, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REFLECT_101);
  cv::Mat spread;
  cv::sqrt(variance, spread);
  return difference / (kLocalUnit * (spread + kSpreadFloor));
}

}  // namespace

WorkingImage::WorkingImage(const cv::Mat& grey)
    : scale(std::min(static_cast<double>(kWidth) / grey.cols, static_cast<double>(kHeight) / grey.rows)) {
  const int width = std::clamp(static_cast<int>(std::lround(grey.cols * scale)), 1, kWidth);
  const int height = std::clamp(static_cast<int>(std::lround(grey.rows * scale)), 1, kHeight);
  region = cv::Rect((kWidth - width) / 2, (kHeight - height) / 2, width, height);
  shift = cv::Point2d(region.x, region.y);
  cv::Mat small;
  cv::resize(grey, small, region.size(), 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::patchNaNs(small, 0);
  std::vector<float> values(small.begin<float>(), small.end<float>());
  const float median = quantile(values, 0.5);
  const float span = std::max(median - quantile(values, kTail), quantile(values, 1 - kTail) - median);
  small = (small - median) / std::max<double>(span, kLeastSpan);
  cv::min(cv::max(small, -3), 3, small);
  for (cv::Mat& plane : planes) plane = cv::Mat(kHeight, kWidth, CV_8U, cv::Scalar(kLevelOfZero));
  asLevels(small).copyTo(planes[0](region));
  asLevels(localContrast(small)).copyTo(planes[1](region));
}

// Pixels have their origin at the centre of the top-left pixel.
cv::Point2d WorkingImage::fromImage(const cv::Point2d& pixel) const {
  return (pixel + cv::Point2d(0.5, 0.5)) * scale + shift - cv::Point2d(0.5, 0.5);
}

cv::Point2d WorkingImage::toImage(const cv::Point2d& pixel) const {
  return (pixel - shift + cv::Point2d(0.5, 0.5)) / scale - cv::Point2d(0.5, 0.5);
}

}  // namespace microinjection
