#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/frame.h"

namespace microinjection {

/// The image along an axis: rows go from the frame's inside towards the shaft, columns across it.
///
///                      side: -half ... 0 ... half
///     row 0             .  .  .  .  .  .  .          before the end
///                       .  .  .  .  .  .  .
///     the end           .  .  '--o--'  .  .
///                       .  .  |  :  |  .  .          walls: columns, mirror images about the middle one
///     row rows - 1      .  .  |  :  |  .  .  --> shaft
///
/// A pipette may come from any side at any angle. In its strip it always goes down and its walls are nearly columns,
/// so that the mirror image of a wall is the same row read backwards, and what belongs to a wall can be summed along
/// a column. The frame is sampled once, bilinearly, in the level of Frame that is as fine as `step`.
class PipetteStrip {
 public:
  struct Shape {
    cv::Point2d origin;    ///< px of the frame, of row 0 and of the middle column
    double direction = 0;  ///< rad, of the rows' order, from x towards y
    int rows = 0;
    int half = 0;     ///< columns to each side of the middle one
    double step = 1;  ///< px, between rows and between columns
  };

  /// @param across, along  steps, standard deviations of the Gaussians
  PipetteStrip(const Frame& frame, const Shape& shape, double across, double along);

  const cv::Mat& grey() const { return grey_; }      ///< CV_32F, smoothed
  const cv::Mat& across() const { return across_; }  ///< CV_32F, derivative along a row, per step
  const cv::Mat& along() const { return along_; }    ///< CV_32F, derivative along a column, per step
  const Shape& shape() const { return shape_; }
  int rows() const { return shape_.rows; }
  int half() const { return shape_.half; }
  cv::Point2d point(double row, double side) const;    ///< px; `side`: columns from the middle one
  bool inside(int row) const { return inside_[row]; }  ///< whether the axis is in the image there
  bool contains(double row, double side) const;        ///< whether a place is in the image

 private:
  Shape shape_;
  cv::Size frame_;
  cv::Mat grey_, across_, along_;
  std::vector<bool> inside_;
};

/// How much of each row is the mirror image of itself: size of the edges that both sides share, up to
/// `half_width[row]` columns from the middle (one entry for each row). The products of both sides are summed before
/// the size is taken, so that those of a texture cancel.
std::vector<double> sharedEdges(const PipetteStrip& strip, const std::vector<double>& half_width);

/// Size of all edges of each row that are along the strip: what sharedEdges() would be, if both sides were mirror
/// images.
std::vector<double> allEdges(const PipetteStrip& strip, const std::vector<double>& half_width);

/// How much rows [first, last) together are their own mirror image about a place `i / 2 - most / 2`
/// columns from the middle, for i = 0 to 2 most: 1 for a perfect image. The signs of edges do not
/// count, because a pipette may be shaded from one side. Empty where there is nothing to compare.
std::vector<double> mirrored(const PipetteStrip& strip, int first, int last, double half_width, int most);

}  // namespace microinjection
