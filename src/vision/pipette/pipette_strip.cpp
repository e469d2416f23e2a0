#include "vision/pipette/pipette_strip.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

cv::Size kernelFor(double across, double along) {
  const int x = static_cast<int>(std::ceil(3 * across)), y = static_cast<int>(std::ceil(3 * along));
  return {2 * std::max(1, x) + 1, 2 * std::max(1, y) + 1};
}

}  // namespace

PipetteStrip::PipetteStrip(const Frame& frame, const Shape& shape, double across, double along)
    : shape_(shape), frame_(frame.grey().size()) {
  const int columns = 2 * shape.half + 1;
  cv::Mat x(shape.rows, columns, CV_32F), y(shape.rows, columns, CV_32F);
  const int level = shape.step < 2 ? 0 : static_cast<int>(std::log2(shape.step));
  const cv::Point2d aside = Frame::toLevel(point(0, 1), level) - Frame::toLevel(point(0, 0), level);
  for (int row = 0; row < shape.rows; ++row) {
    inside_.push_back(frame.contains(point(row, 0), 1));
    const cv::Point2d middle = Frame::toLevel(point(row, 0), level);
    float *to_x = x.ptr<float>(row) + shape.half, *to_y = y.ptr<float>(row) + shape.half;
    for (int side = -shape.half; side <= shape.half; ++side) {
      to_x[side] = static_cast<float>(middle.x + side * aside.x);
      to_y[side] = static_cast<float>(middle.y + side * aside.y);
    }
  }
  cv::Mat raw;
  cv::remap(frame.level(level), raw, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::GaussianBlur(raw, grey_, kernelFor(across, along), across, along, cv::BORDER_REPLICATE);
  const cv::Mat row = (cv::Mat_<float>(1, 3) << -0.5F, 0, 0.5F);
  cv::filter2D(grey_, across_, CV_32F, row, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
  cv::filter2D(grey_, along_, CV_32F, row.t(), cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
}

cv::Point2d PipetteStrip::point(double row, double side) const {
  const double c = std::cos(shape_.direction), s = std::sin(shape_.direction);
  return shape_.origin + shape_.step * (row * cv::Point2d(c, s) + side * cv::Point2d(-s, c));
}

bool PipetteStrip::contains(double row, double side) const {
  const cv::Point2d place = point(row, side);
  return place.x >= 1 && place.y >= 1 && place.x <= frame_.width - 2 && place.y <= frame_.height - 2;
}

std::vector<double> sharedEdges(const PipetteStrip& strip, const std::vector<double>& half_width) {
  std::vector<double> shared(strip.rows(), 0.0);
  for (int row = 0; row < strip.rows(); ++row) {
    if (!strip.inside(row)) continue;
    const float* d = strip.across().ptr<float>(row) + strip.half();
    const int last = std::clamp(static_cast<int>(half_width[row]), 2, strip.half());
    double sum = 0;
    for (int t = 1; t <= last; ++t) sum += d[t] * d[-t];
    shared[row] = std::sqrt(std::abs(sum));
  }
  return shared;
}

std::vector<double> allEdges(const PipetteStrip& strip, const std::vector<double>& half_width) {
  std::vector<double> all(strip.rows(), 0.0);
  for (int row = 0; row < strip.rows(); ++row) {
    if (!strip.inside(row)) continue;
    const float* d = strip.across().ptr<float>(row) + strip.half();
    const int last = std::clamp(static_cast<int>(half_width[row]), 2, strip.half());
    double sum = 0;
    for (int t = -last; t <= last; ++t) sum += d[t] * d[t];
    all[row] = std::sqrt(0.5 * sum);
  }
  return all;
}

std::vector<double> mirrored(const PipetteStrip& strip, int first, int last, double half_width, int most) {
  const int half = std::min(static_cast<int>(half_width), strip.half() - most - 1);
  if (half < 4) return {};
  std::vector<double> sum(2 * most + 1, 0.0);
  double energy = 0;
  for (int row = std::max(0, first); row < std::min(last, strip.rows()); ++row) {
    if (!strip.inside(row)) continue;
    const float* d = strip.across().ptr<float>(row) + strip.half();
    for (int t = -half; t <= half; ++t) {
      energy += d[t] * d[t];
      for (int k = -most; k <= most; ++k) sum[k + most] += std::abs(d[t] * d[k - t]);
    }
  }
  if (!(energy > 0)) return {};
  for (double& value : sum) value /= energy;
  return sum;
}

}  // namespace microinjection
