#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// Sign of a border's gradient, outwards: kRising is dark inside. kEither takes both, for a contrast mode
/// that shades one side of a cell and lightens the other.
enum class Polarity { kRising, kFalling, kEither };

/// The grey values around a centre by direction (rows) and radius (columns), and their derivative
/// outwards. Radii count from a base: a point, or an ellipse, whose border is then a straight column.
/// A ray's part outside of the image has the derivative 0 and is not valid.
class PolarMap {
 public:
  struct Range {
    double low = 0, high = 0;  ///< px from the base, of the first and the last column
    int columns = 0, rays = 0;
  };

  /// @param smoothing  standard deviation (columns) of the Gaussian along the radius; 0: the derivative is left out
  PolarMap(const Frame& frame, const Ellipse& base, const Range& range, double smoothing);
  PolarMap(const Frame& frame, const cv::Point2d& centre, const Range& range, double smoothing)
      : PolarMap(frame, Ellipse{centre, {0, 0}, 0}, range, smoothing) {}

  const cv::Mat& grey() const { return grey_; }    ///< CV_32F, rays x columns
  const cv::Mat& slope() const { return slope_; }  ///< CV_32F, change per column
  const cv::Mat& valid() const { return valid_; }  ///< CV_8U, 0 outside of the image
  int rays() const { return grey_.rows; }
  int columns() const { return grey_.cols; }
  double step() const { return step_; }  ///< px, between columns
  /// Radius (px) from the centre, and the column of a radius, which may be outside of the map.
  double radius(int ray, double column) const { return base_[ray] + low_ + column * step_; }
  double column(int ray, double radius) const { return (radius - base_[ray] - low_) / step_; }
  double direction(int ray) const;                  ///< rad, from x towards y
  cv::Point2d point(int ray, double column) const;  ///< px in the frame
  const cv::Point2d& centre() const { return centre_; }

 private:
  cv::Point2d centre_;
  double low_, step_;
  std::vector<double> base_;  ///< px, of each ray
  cv::Mat grey_, slope_, valid_;
};

/// A faint line is averaged over the rays of a sector: the sectors of a map, and the rays of each.
constexpr int kAveragedSectors = 12, kRaysOfAveragedSector = 15;

/// A closed path around the centre: one column for each ray.
struct ClosedPath {
  std::vector<int> column;
  double strength = 0;  ///< mean of the values along it
};

/// The path of the largest sum of `value` (CV_32F, rays x columns) that moves by at most
/// `max_change` columns from ray to ray and ends where it began. Dynamic programming over two turns;
/// columns with value <= kForbidden are not entered while there is another way.
ClosedPath closedPath(const cv::Mat& value, int max_change);
constexpr float kForbidden = -100;

/// Strength of a border at each place: the slope with the sign of `polarity`, relative to `scale`,
/// cut at 1 and at -0.3.
cv::Mat borderStrength(const PolarMap& map, Polarity polarity, double scale);

/// Robust size of the slopes in the columns [first, last).
double slopeScale(const PolarMap& map, int first, int last);

}  // namespace microinjection
