#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace microinjection {

/// A frame as the detectors use it. Pixels have their origin at the centre of the top-left pixel, x
/// right, y down.
class Frame {
 public:
  /// Takes 8-bit, 16-bit or float images with 1, 3 (BGR) or 4 (BGRA) channels. A frame that cannot
  /// show anything has a refusal, and nothing else is defined.
  explicit Frame(const cv::Mat& image);

  /// Empty, or why nothing can be detected: no image, too small, all one grey, over-exposed, black.
  const std::string& refusal() const { return refusal_; }
  const cv::Mat& grey() const { return grey_; }      ///< CV_32F, full scale of the format is 1
  double noise() const { return noise_; }            ///< standard deviation of a pixel, of full scale
  double background() const { return background_; }  ///< grey value that a quarter of the pixels exceed
  double width() const { return grey_.cols; }        ///< px
  double height() const { return grey_.rows; }       ///< px
  bool contains(const cv::Point2d& point, double margin = 0) const;

  /// The frame reduced by 2^level by averaging squares of pixels; level 0 is the frame. Made when it
  /// is first asked for: not for two threads at once.
  const cv::Mat& level(int level) const;
  /// Place in a reduced frame of a place (px) in the frame, and back.
  static cv::Point2d toLevel(const cv::Point2d& point, int level);
  static cv::Point2d fromLevel(const cv::Point2d& point, int level);
  /// The frame reduced by 2^level as a frame of its own; enlarged by 2^-level where that is negative.
  Frame resized(int level) const;

 private:
  std::string refusal_;
  cv::Mat grey_;
  double noise_ = 0, background_ = 0;
  double least_noise_ = 0;  ///< of the format
  mutable std::vector<cv::Mat> levels_;
};

}  // namespace microinjection
