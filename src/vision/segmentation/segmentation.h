#pragma once

#include <array>
#include <initializer_list>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vision/segmentation/pixel_class.h"
#include "vision/segmentation/working_image.h"

namespace microinjection {

/// Connected pixels of one or several classes; places and lengths are in px of the frame.
struct ClassRegion {
  cv::Point2d centre{0, 0};
  double diameter = 0;  ///< of the circle with the region's area, holes filled
  double area = 0;      ///< px^2
  /// Semi-axes of the ellipse with the region's second moments, long and short, and the long one's angle in [0, pi)
  /// from x towards y (down). Without meaning for a region that the frame cuts.
  double semi_major = 0, semi_minor = 0, angle = 0;
  double probability = 0;       ///< mean over the region, of being one of the classes
  bool touches_border = false;  ///< of the frame
  cv::Mat mask;                 ///< CV_8U, 255 inside; of the output's size
};

/// Of a region that enters through the frame's border: the middle of where it does, and of its end in the frame, px.
struct RegionWay {
  cv::Point2d entry, end;
};

/// What the network says of a frame: a probability of each class for each output pixel, of which there are kWidth x
/// kHeight, half as many in a row as the working image has.
class Segmentation {
 public:
  static constexpr int kWidth = WorkingImage::kWidth / 2, kHeight = WorkingImage::kHeight / 2;

  /// `probabilities`: CV_32F, of kHeight x kWidth, in the order of PixelClass. `working`: of the frame.
  Segmentation(std::array<cv::Mat, kPixelClasses> probabilities, const WorkingImage& working, const cv::Size& frame);

  /// CV_32F in [0, 1], of the output's size; 0 beside the frame.
  const cv::Mat& probability(PixelClass pixel_class) const;
  /// Of being one of several classes.
  cv::Mat probability(std::initializer_list<PixelClass> classes) const;
  /// The likeliest class of each output pixel, CV_8U (PixelClass); background beside the frame.
  const cv::Mat& classes() const { return classes_; }
  /// 255 where the likeliest class is one of these.
  cv::Mat mask(std::initializer_list<PixelClass> classes) const;

  /// Connected regions of a probability above `inside`, the largest first. Smaller ones than `least` (px^2 of the
  /// frame) and than 4 output pixels are left out. An area counts the probabilities along the border, so that it is
  /// finer than the output's pixels.
  /// @param inside  probability above which a pixel counts
  /// @param closing  output px, half width of gaps that do not part a region
  std::vector<ClassRegion> regions(std::initializer_list<PixelClass> classes, double least = 0, double inside = 0.5,
                                   int closing = 0) const;
  /// The largest of them.
  std::optional<ClassRegion> largestRegion(std::initializer_list<PixelClass> classes) const;

  /// Of a region that enters through the frame's border, as that of a pipette does. None for a region that does not
  /// touch the border.
  std::optional<RegionWay> wayOf(const ClassRegion& region) const;

  /// px of the frame in a row of one output pixel.
  double framePixels() const { return 2 / working_.scale; }
  /// px of the frame at px of the output, and back.
  cv::Point2d toFrame(const cv::Point2d& output) const;
  cv::Point2d fromFrame(const cv::Point2d& pixel) const;

 private:
  ClassRegion regionOf(const cv::Mat& component, const cv::Mat& probability) const;

  std::array<cv::Mat, kPixelClasses> probabilities_;
  WorkingImage working_;
  cv::Size frame_;
  cv::Rect inside_;  ///< output px that the frame fills
  cv::Mat classes_;
};

}  // namespace microinjection
