#pragma once

#include <vector>

#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// Grey values in a band about an ellipse, averaged over sectors of directions. A sector's mean leaves
/// out its darkest and its brightest ray, so that a speck of dust counts less.
class LayerSamples {
 public:
  /// @param low, high  px from the ellipse, positive outwards, in steps of 1 px
  LayerSamples(const Frame& frame, const Ellipse& base, double low, double high, int sectors);

  int sectors() const { return grey_.rows; }
  int columns() const { return grey_.cols; }
  float grey(int sector, int column) const { return grey_.at<float>(sector, column); }
  bool valid(int sector, int column) const { return valid_.at<unsigned char>(sector, column) != 0; }
  double place(int column) const { return low_ + column; }     ///< px from the ellipse
  double direction(int sector) const;                          ///< rad, of the sector's middle
  double radius(int sector) const { return radius_[sector]; }  ///< px, of the ellipse
  const Ellipse& base() const { return base_; }

 private:
  Ellipse base_;
  double low_;
  cv::Mat grey_, valid_;
  std::vector<double> radius_;
};

}  // namespace microinjection
