#include "vision/microscope/outline_distance.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr int kCoarse = 4;   // px, a power of two, for which warpAffine's fractions are exact
constexpr float kNear = 10;  // px, where distances are exact
constexpr int kSkipped = 4;  // corners of the outline in a side of the coarse one

using Outline = std::vector<Eigen::Vector2f>;

/// Squared distances (grid units) to the outline where they are below band^2; band^2 elsewhere.
void lowerToOutline(const Outline& outline, float band, cv::Mat& squared) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2f& a = outline[k];
    const Eigen::Vector2f& b = outline[(k + 1) % outline.size()];
    const Eigen::Vector2f side = b - a;
    const float length = side.squaredNorm(), scale = length > 0 ? 1 / length : 0;
    const int left = std::max(0, static_cast<int>(std::ceil(std::min(a.x(), b.x()) - band)));
    const int right = std::min(squared.cols - 1, static_cast<int>(std::floor(std::max(a.x(), b.x()) + band)));
    const int top = std::max(0, static_cast<int>(std::ceil(std::min(a.y(), b.y()) - band)));
    const int bottom = std::min(squared.rows - 1, static_cast<int>(std::floor(std::max(a.y(), b.y()) + band)));
    for (int y = top; y <= bottom; ++y) {
      float* row = squared.ptr<float>(y);
      const float dy = static_cast<float>(y) - a.y();
      for (int x = left; x <= right; ++x) {
        const float dx = static_cast<float>(x) - a.x();
        const float t = std::clamp((dx * side.x() + dy * side.y()) * scale, 0.0F, 1.0F);
        const float ex = dx - t * side.x(), ey = dy - t * side.y();
        row[x] = std::min(row[x], ex * ex + ey * ey);
      }
    }
  }
}

/// Takes the root, and the sign by the crossings of each row with the outline.
void takeRootAndSign(const Outline& outline, cv::Mat& squared) {
  std::vector<std::vector<float>> crossings(squared.rows);
  for (std::size_t k = 0; k < outline.size(); ++k) {
    Eigen::Vector2f a = outline[k], b = outline[(k + 1) % outline.size()];
    if (a.y() > b.y()) std::swap(a, b);
    const int top = std::max(0, static_cast<int>(std::ceil(a.y())));
    for (int y = top; y < squared.rows && static_cast<float>(y) < b.y(); ++y) {
      const float t = (static_cast<float>(y) - a.y()) / (b.y() - a.y());
      crossings[y].push_back(a.x() + t * (b.x() - a.x()));
    }
  }
  for (int y = 0; y < squared.rows; ++y) {
    std::sort(crossings[y].begin(), crossings[y].end());
    float* row = squared.ptr<float>(y);
    std::size_t passed = 0;
    for (int x = 0; x < squared.cols; ++x) {
      while (passed < crossings[y].size() && crossings[y][passed] <= static_cast<float>(x)) ++passed;
      row[x] = (passed % 2 ? 1.0F : -1.0F) * std::sqrt(row[x]);
    }
  }
}

/// The outline on a grid whose origin is at `origin` px and whose step is `step` px.
Outline onGrid(const std::vector<Eigen::Vector2d>& outline, const cv::Point& origin, int step, std::size_t skipped) {
  Outline result;
  for (std::size_t k = 0; k < outline.size(); k += skipped)
    result.emplace_back((outline[k] - Eigen::Vector2d(origin.x, origin.y)).cast<float>() / static_cast<float>(step));
  return result;
}

cv::Mat distanceOnGrid(const Outline& outline, float band, const cv::Size& size) {
  cv::Mat distance(size, CV_32F, cv::Scalar(band * band));
  lowerToOutline(outline, band, distance);
  takeRootAndSign(outline, distance);
  return distance;
}

cv::Rect regionOf(const std::vector<Eigen::Vector2d>& outline, double band, const cv::Size& image) {
  Eigen::Array2d low = outline.front(), high = low;
  for (const Eigen::Vector2d& corner : outline) {
    low = low.min(corner.array());
    high = high.max(corner.array());
  }
  // Cut before the conversion, so that an outline far away does not overflow.
  const Eigen::Array2d size(image.width, image.height);
  low = (low - band).floor().max(0).min(size);
  high = (high + band + 1).ceil().max(0).min(size);
  const Eigen::Array2i begin = low.cast<int>(), end = high.cast<int>();
  return cv::Rect(cv::Point(begin.x(), begin.y()), cv::Point(end.x(), end.y()));
}

}  // namespace

OutlineDistance outlineDistance(const std::vector<Eigen::Vector2d>& outline, double band, const cv::Size& image) {
  OutlineDistance result{regionOf(outline, band, image), {}};
  if (result.region.empty()) return result;
  const auto wide = static_cast<float>(band);
  const Outline fine = onGrid(outline, result.region.tl(), 1, 1);
  if (wide <= 2 * kNear) {
    result.distance = distanceOnGrid(fine, wide, result.region.size());
    return result;
  }
  const Outline coarse = onGrid(outline, result.region.tl(), kCoarse, outline.size() > 64 ? kSkipped : 1);
  const cv::Size size(result.region.width / kCoarse + 2, result.region.height / kCoarse + 2);
  // Nodes just outside the band take part in the interpolation.
  const cv::Mat far = distanceOnGrid(coarse, wide / kCoarse + 2, size) * kCoarse;
  const cv::Matx23d to_coarse(1.0 / kCoarse, 0, 0, 0, 1.0 / kCoarse, 0);
  cv::warpAffine(far, result.distance, to_coarse, result.region.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  const cv::Mat near = distanceOnGrid(fine, kNear, result.region.size());
  near.copyTo(result.distance, cv::abs(near) < kNear);
  return result;
}

}  // namespace microinjection
