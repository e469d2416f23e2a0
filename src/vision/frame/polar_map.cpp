#include "vision/frame/polar_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

/// The coarsest reduction of the frame whose pixels are not larger than the map's steps.
int levelFor(double step) { return step < 2 ? 0 : std::min(5, static_cast<int>(std::floor(std::log2(step)))); }

void derive(const cv::Mat& grey, const cv::Mat& valid, double smoothing, cv::Mat& slope) {
  cv::Mat smooth;
  // Across the rays a little: a border is as wide as several of them.
  const int half = std::max(1, static_cast<int>(std::ceil(3 * smoothing)));
  cv::GaussianBlur(grey, smooth, cv::Size(2 * half + 1, 3), smoothing, 0.7, cv::BORDER_REPLICATE);
  const float kernel[3] = {-0.5F, 0, 0.5F};
  cv::filter2D(smooth, slope, CV_32F, cv::Mat(1, 3, CV_32F, const_cast<float*>(kernel)), cv::Point(-1, -1), 0,
               cv::BORDER_REPLICATE);
  cv::Mat outside;
  cv::dilate(valid == 0, outside, cv::Mat::ones(1, 2 * half + 3, CV_8U));
  slope.setTo(0, outside);
}

}  // namespace

PolarMap::PolarMap(const Frame& frame, const Ellipse& base, const Range& range, double smoothing)
    : centre_(base.centre), low_(range.low), step_((range.high - range.low) / (range.columns - 1)) {
  const int level = levelFor(step_);
  const cv::Mat& image = frame.level(level);
  cv::Mat x(range.rays, range.columns, CV_32F), y(range.rays, range.columns, CV_32F);
  grey_.create(range.rays, range.columns, CV_32F);
  valid_.create(range.rays, range.columns, CV_8U);
  const cv::Point2d origin = Frame::toLevel(centre_, level);
  const double scale = std::ldexp(1, -level);
  for (int ray = 0; ray < range.rays; ++ray) {
    const double angle = direction(ray), ux = std::cos(angle) * scale, uy = std::sin(angle) * scale;
    base_.push_back(base.semi_axes[1] > 0 ? base.radius(angle) : 0);
    for (int i = 0; i < range.columns; ++i) {
      const double px = origin.x + radius(ray, i) * ux, py = origin.y + radius(ray, i) * uy;
      x.at<float>(ray, i) = static_cast<float>(px);
      y.at<float>(ray, i) = static_cast<float>(py);
      valid_.at<unsigned char>(ray, i) = px >= 0 && py >= 0 && px <= image.cols - 1 && py <= image.rows - 1 ? 255 : 0;
    }
  }
  cv::remap(image, grey_, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  if (smoothing > 0) derive(grey_, valid_, smoothing, slope_);
}

double PolarMap::direction(int ray) const { return 2 * M_PI * ray / rays(); }

cv::Point2d PolarMap::point(int ray, double column) const {
  const double r = radius(ray, column), angle = direction(ray);
  return centre_ + cv::Point2d(r * std::cos(angle), r * std::sin(angle));
}

ClosedPath closedPath(const cv::Mat& value, int max_change) {
  const int rays = value.rows, columns = value.cols, turns = 2 * rays;
  // Margins that no path enters: the loop over the columns has no branches.
  std::vector<float> padded(static_cast<std::size_t>(columns) + 2 * max_change, -1e30F), next(columns);
  float* const sum = padded.data() + max_change;
  std::copy_n(value.ptr<float>(0), columns, sum);
  cv::Mat from(turns, columns, CV_16S);
  for (int i = 1; i < turns; ++i) {
    const float* gain = value.ptr<float>(i % rays);
    short* origin = from.ptr<short>(i);
    std::copy_n(sum, columns, next.begin());
    for (int c = 0; c < columns; ++c) origin[c] = static_cast<short>(c);
    for (int change = -max_change; change <= max_change; ++change) {
      // A small price for each change keeps the path straight where nothing guides it.
      const float price = 0.05F * static_cast<float>(std::abs(change));
      for (int c = 0; c < columns; ++c) {
        const float there = sum[c + change] - price;
        const bool better = there > next[c];
        next[c] = better ? there : next[c];
        origin[c] = better ? static_cast<short>(c + change) : origin[c];
      }
    }
    for (int c = 0; c < columns; ++c) sum[c] = next[c] + gain[c];
  }
  int column = static_cast<int>(std::max_element(sum, sum + columns) - sum);
  std::vector<int> whole(turns);
  for (int i = turns - 1; i >= 0; --i) {
    whole[i] = column;
    if (i > 0) column = from.at<short>(i, column);
  }
  // The middle turn has forgotten where the path began and does not know yet where it ends.
  ClosedPath path;
  path.column.resize(rays);
  for (int i = rays / 2; i < rays / 2 + rays; ++i) path.column[i % rays] = whole[i];
  for (int i = 0; i < rays; ++i) path.strength += value.at<float>(i, path.column[i]) / rays;
  return path;
}

cv::Mat borderStrength(const PolarMap& map, Polarity polarity, double scale) {
  cv::Mat strength;
  if (polarity == Polarity::kEither) {
    strength = cv::abs(map.slope());
  } else {
    strength = polarity == Polarity::kRising ? map.slope().clone() : cv::Mat(-map.slope());
  }
  strength /= std::max(scale, 1e-12);
  return cv::min(cv::max(strength, -0.3), 1.0);
}

double slopeScale(const PolarMap& map, int first, int last) {
  std::vector<float> sizes;
  for (int ray = 0; ray < map.rays(); ++ray) {
    for (int i = std::max(first, 0); i < std::min(last, map.columns()); ++i) {
      if (map.valid().at<unsigned char>(ray, i) != 0) sizes.push_back(std::abs(map.slope().at<float>(ray, i)));
    }
  }
  if (sizes.empty()) return 1e-9;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max<double>(*middle, 1e-9);
}

}  // namespace microinjection
