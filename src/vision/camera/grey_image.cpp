#include "vision/camera/grey_image.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace microinjection {
namespace {

constexpr int kSamples = 256;  // along each side

template <typename Level>
std::vector<Level> sampled(const cv::Mat& grey) {
  const int down = std::max(1, grey.rows / kSamples), right = std::max(1, grey.cols / kSamples);
  std::vector<Level> levels;
  levels.reserve(4 * kSamples * kSamples);
  for (int y = 0; y < grey.rows; y += down) {
    const Level* row = grey.ptr<Level>(y);
    for (int x = 0; x < grey.cols; x += right) levels.push_back(row[x]);
  }
  return levels;
}

template <typename Level>
GreyRange rangeOf(std::vector<Level> levels, double tail) {
  if (levels.empty()) return {};
  const auto below = static_cast<std::ptrdiff_t>(tail * static_cast<double>(levels.size()));
  const auto low = levels.begin() + below, high = levels.end() - 1 - below;
  std::nth_element(levels.begin(), low, levels.end());
  const double lowest = *low;
  std::nth_element(low, high, levels.end());
  return {lowest, static_cast<double>(*high)};
}

}  // namespace

cv::Mat toGrey(const cv::Mat& frame) {
  CV_Assert(frame.depth() == CV_8U || frame.depth() == CV_16U);
  cv::Mat grey;
  if (frame.channels() == 1) return frame;
  CV_Assert(frame.channels() == 3 || frame.channels() == 4);
  cv::cvtColor(frame, grey, frame.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  return grey;
}

GreyRange greyRange(const cv::Mat& grey, double tail) {
  CV_Assert(grey.channels() == 1 && tail >= 0 && tail < 0.5);
  if (grey.depth() == CV_8U) return rangeOf(sampled<unsigned char>(grey), tail);
  CV_Assert(grey.depth() == CV_16U);
  return rangeOf(sampled<unsigned short>(grey), tail);
}

cv::Mat toGrey8(const cv::Mat& frame, double tail) {
  const cv::Mat grey = toGrey(frame);
  const GreyRange range = greyRange(grey, tail);
  if (range.high <= range.low) return cv::Mat(grey.size(), CV_8U, cv::Scalar(128));
  const double scale = 255 / (range.high - range.low);
  cv::Mat result;
  grey.convertTo(result, CV_8U, scale, -scale * range.low);
  return result;
}

}  // namespace microinjection
