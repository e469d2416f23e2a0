#include "vision/frame/frame.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr int kSmallestSide = 32;         // px, of a side
constexpr double kMostSaturated = 0.95;   // of the pixels
constexpr double kLeastContrast = 0.004;  // of full scale, between the 0.5th and the 99.5th percentile
constexpr int kStride = 7;                // of the pixels that the statistics look at

cv::Mat toGrey(const cv::Mat& image) {
  cv::Mat one;
  if (image.channels() == 1) {
    one = image;
  } else {
    cv::cvtColor(image, one, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  }
  const double scale = one.depth() == CV_8U ? 1 / 255. : one.depth() == CV_16U ? 1 / 65535. : 1;
  cv::Mat grey;
  one.convertTo(grey, CV_32F, scale);
  return grey;
}

bool isFormat(const cv::Mat& image) {
  const int depth = image.depth(), channels = image.channels();
  return (depth == CV_8U || depth == CV_16U || depth == CV_32F) && (channels == 1 || channels == 3 || channels == 4);
}

std::vector<float> sampled(const cv::Mat& grey) {
  std::vector<float> values;
  values.reserve(grey.total() / (kStride * kStride) + 1);
  for (int y = 0; y < grey.rows; y += kStride) {
    const float* row = grey.ptr<float>(y);
    for (int x = 0; x < grey.cols; x += kStride) values.push_back(row[x]);
  }
  return values;
}

float quantileOf(std::vector<float>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Immerkaer's mask (Computer Vision and Image Understanding 64, 1996) does not see planes and
/// straight edges along the axes; the median does not see the rest of the structure.
double noiseOf(const cv::Mat& grey) {
  std::vector<float> response;
  for (int y = 1; y + 1 < grey.rows; y += kStride) {
    const float *a = grey.ptr<float>(y - 1), *b = grey.ptr<float>(y), *c = grey.ptr<float>(y + 1);
    for (int x = 1; x + 1 < grey.cols; x += kStride) {
      response.push_back(std::abs(a[x - 1] - 2 * a[x] + a[x + 1] - 2 * (b[x - 1] - 2 * b[x] + b[x + 1]) + c[x - 1] -
                                  2 * c[x] + c[x + 1]));
    }
  }
  return quantileOf(response, 0.5) / (0.6745 * 6);
}

}  // namespace

Frame::Frame(const cv::Mat& image) {
  if (image.empty() || image.dims != 2) {
    refusal_ = "the frame is empty";
  } else if (!isFormat(image)) {
    refusal_ = "the frame's format is not known: 8 or 16 bit or float with 1, 3 or 4 channels";
  } else if (std::min(image.rows, image.cols) < kSmallestSide) {
    refusal_ = "the frame is truncated: a side has fewer than 32 pixels";
  }
  if (!refusal_.empty()) return;
  grey_ = toGrey(image);
  if (image.depth() == CV_32F && !cv::checkRange(grey_)) {
    refusal_ = "the frame has values that are not finite";
    return;
  }
  std::vector<float> values = sampled(grey_);
  const double top = image.depth() == CV_32F ? 1 : 0.999;
  const auto saturated = std::count_if(values.begin(), values.end(), [top](float value) { return value >= top; });
  const float low = quantileOf(values, 0.005), high = quantileOf(values, 0.995);
  background_ = quantileOf(values, 0.75);
  if (static_cast<double>(saturated) > kMostSaturated * static_cast<double>(values.size())) {
    refusal_ = "the frame is over-exposed: almost every pixel is saturated";
  } else if (high - low < kLeastContrast) {
    refusal_ = high < kLeastContrast ? "the frame is black" : "the frame is all one grey";
  }
  // A format of few levels hides noise; rounding is then the noise.
  least_noise_ = image.depth() == CV_8U ? 0.3 / 255 : 1e-5;
  noise_ = std::max(noiseOf(grey_), least_noise_);
}

Frame Frame::resized(int level) const {
  Frame frame = *this;
  frame.levels_.clear();
  if (!refusal_.empty() || level == 0) return frame;
  if (level < 0) {
    const double scale = std::ldexp(1, -level);
    cv::resize(grey_, frame.grey_, {}, scale, scale, cv::INTER_CUBIC);
    return frame;
  }
  frame.grey_ = this->level(level);
  frame.noise_ = std::max(noiseOf(frame.grey_), least_noise_);
  return frame;
}

bool Frame::contains(const cv::Point2d& point, double margin) const {
  return point.x >= margin && point.y >= margin && point.x <= width() - 1 - margin && point.y <= height() - 1 - margin;
}

const cv::Mat& Frame::level(int level) const {
  if (level <= 0) return grey_;
  while (static_cast<int>(levels_.size()) < level) {
    const cv::Mat& above = levels_.empty() ? grey_ : levels_.back();
    // Whole squares only: otherwise the scale would differ from 2 by the odd row.
    const cv::Mat even = above(cv::Rect(0, 0, above.cols & ~1, above.rows & ~1));
    cv::Mat half;
    cv::resize(even, half, cv::Size(even.cols / 2, even.rows / 2), 0, 0, cv::INTER_AREA);
    levels_.push_back(half);
  }
  return levels_[static_cast<std::size_t>(level) - 1];
}

cv::Point2d Frame::toLevel(const cv::Point2d& point, int level) {
  const double scale = std::ldexp(1, level);
  return {(point.x + 0.5) / scale - 0.5, (point.y + 0.5) / scale - 0.5};
}

cv::Point2d Frame::fromLevel(const cv::Point2d& point, int level) {
  const double scale = std::ldexp(1, level);
  return {(point.x + 0.5) * scale - 0.5, (point.y + 0.5) * scale - 0.5};
}

}  // namespace microinjection
