#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace microinjection {

/// A frame as the detectors use it: grey values, noise and smaller copies, made of whatever image a camera or a file
/// has. Each detector could convert for itself; but then limits would mean one thing in 8 bit and another in 16, and
/// the same picture would be reduced by each of them anew.
///
///     level 0  +---+---+---+---+--> x       level 1  +-------+-------+      a place p of level 0 is at level l
///              |0,0|1,0|2,0|3,0|                     |  0,0  |  1,0  |
///              +---+---+---+---+                     |       |       |      (p + 0.5) / 2^l - 0.5
///              |0,1|1,1|2,1|3,1|                     +-------+-------+
///              +---+---+---+---+
///            y v
///
/// Pixels have their origin at the centre of the top-left pixel, x right, y down. Grey values have the full scale of
/// the format as 1, so that constants hold for all formats. The noise is known because a slope shows a border only
/// where noise alone does not make such slopes. It is estimated by the median of Immerkaer's mask (Computer Vision
/// and Image Understanding 64, 1996), which does not see planes and straight edges along the axes, nor, as a median,
/// the rest of the structure. A format of few levels hides noise; its rounding is then the least.
class Frame {
 public:
  /// Takes 8-bit, 16-bit or float images with 1, 3 (BGR) or 4 (BGRA) channels; float ones have 1 as their full scale.
  /// A frame that cannot show anything has a refusal, and nothing else is defined: a detector then says why it finds
  /// nothing, instead of searching in the dark.
  explicit Frame(const cv::Mat& image);

  /// Empty, or why nothing can be detected: no image, too small, all one grey, over-exposed, black.
  const std::string& refusal() const { return refusal_; }
  const cv::Mat& grey() const { return grey_; }      ///< CV_32F, full scale of the format is 1
  double noise() const { return noise_; }            ///< standard deviation of a pixel, of full scale
  double background() const { return background_; }  ///< grey value that a quarter of the pixels exceed
  double width() const { return grey_.cols; }        ///< px
  double height() const { return grey_.rows; }       ///< px
  /// Whether a place (px) is at least `margin` px within the centres of the outermost pixels.
  bool contains(const cv::Point2d& point, double margin = 0) const;

  /// The frame reduced by 2^level by averaging squares of pixels; level 0 is the frame. @pre level >= 0. An odd row
  /// or column is left out. Made when it is first asked for: not for two threads at once.
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
