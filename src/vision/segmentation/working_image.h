#pragma once

#include <opencv2/core.hpp>

namespace microinjection {

/// An image as the segmentation network sees it: shrunk or enlarged to fit kWidth x kHeight with its aspect ratio kept,
/// in the middle, with the rest filled with its median grey.
///
/// Two planes show it. In the first, grey levels are relative to the median and to the larger of the two distances from
/// there to the 0.5th and the 99.5th percentile, so that neither light nor exposure matters. In the second they are
/// relative to the mean and the spread of the neighbourhood: what is faint beside something bright is seen there. 128
/// is the median or the mean, and 48 levels are the distance or the spread.
struct WorkingImage {
  static constexpr int kWidth = 256, kHeight = 192;  ///< px
  static constexpr int kPlanes = 2;
  static constexpr double kLevelOfZero = 128, kLevelsPerUnit = 48;

  /// Takes a CV_32F image of one channel, not empty. Values that are not finite count as 0.
  explicit WorkingImage(const cv::Mat& grey);

  cv::Mat planes[kPlanes];  ///< CV_8U
  double scale = 1;         ///< working px per px of the image
  cv::Point2d shift;        ///< working px, of the image's top-left corner
  cv::Rect region;          ///< working px, that the image fills

  cv::Point2d fromImage(const cv::Point2d& pixel) const;
  cv::Point2d toImage(const cv::Point2d& pixel) const;
};

}  // namespace microinjection
