#include "vision/layers/cell_candidates.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr double kSmallestRadius = 12;  // px in the reduced frame, whose pixels then blur a border by a tenth of it
constexpr double kBinRatio = 1.12;
constexpr double kLeastVotes = 0.12;
constexpr double kEdgeNoise = 4;  // of the gradient's noise, the least gradient of an edge

struct Edge {
  float x, y, ux, uy;  ///< place, unit gradient
};

/// Thinned edges of the reduced frame. Every edge counts the same: a faint border of a cell is not
/// to lose against a strong one of the dish.
std::vector<Edge> edgesOf(const cv::Mat& image, double noise) {
  cv::Mat smooth, gx, gy;
  cv::GaussianBlur(image, smooth, cv::Size(5, 5), 1);
  cv::Sobel(smooth, gx, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(smooth, gy, CV_32F, 0, 1, 3, 0.125);
  cv::Mat size;
  cv::magnitude(gx, gy, size);
  const float least = static_cast<float>(kEdgeNoise * noise);
  std::vector<Edge> edges;
  for (int y = 2; y < image.rows - 2; ++y) {
    for (int x = 2; x < image.cols - 2; ++x) {
      const float g = size.at<float>(y, x);
      if (g < least) continue;
      const float ux = gx.at<float>(y, x) / g, uy = gy.at<float>(y, x) / g;
      const int dx = static_cast<int>(std::lround(ux)), dy = static_cast<int>(std::lround(uy));
      if (size.at<float>(y + dy, x + dx) > g || size.at<float>(y - dy, x - dx) >= g) continue;
      edges.push_back({static_cast<float>(x), static_cast<float>(y), ux, uy});
    }
  }
  return edges;
}

/// Votes for the centres of circles with radii [low, high).
cv::Mat votes(const std::vector<Edge>& edges, const cv::Size& size, double low, double high) {
  cv::Mat count = cv::Mat::zeros(size, CV_32F);
  const int steps = std::max(1, static_cast<int>(std::ceil(high - low)));
  for (const Edge& edge : edges) {
    for (int sign = -1; sign <= 1; sign += 2) {
      for (int i = 0; i < steps; ++i) {
        const double r = sign * (low + (i + 0.5) * (high - low) / steps);
        const int x = cvRound(edge.x + r * edge.ux);
        const int y = cvRound(edge.y + r * edge.uy);
        if (x >= 0 && y >= 0 && x < size.width && y < size.height)
          count.at<float>(y, x) += 1.F / static_cast<float>(steps);
      }
    }
  }
  return count;
}

/// Sums the votes within a radius that an ellipse spreads them over, and relates them to the edge
/// pixels of a whole circle.
cv::Mat shareOf(const cv::Mat& count, double radius) {
  const int half = std::max(1, static_cast<int>(std::lround(0.12 * radius)));
  cv::Mat share;
  cv::boxFilter(count, share, CV_32F, cv::Size(2 * half + 1, 2 * half + 1), cv::Point(-1, -1), false,
                cv::BORDER_CONSTANT);
  cv::GaussianBlur(share, share, cv::Size(2 * half + 1, 2 * half + 1), 0.5 * half, 0, cv::BORDER_CONSTANT);
  return share / (2 * M_PI * radius);
}

void addMaxima(const cv::Mat& share, double radius, std::vector<CellCandidate>& found) {
  const int half = std::max(1, static_cast<int>(std::lround(0.3 * radius)));
  cv::Mat highest;
  cv::dilate(share, highest, cv::Mat::ones(2 * half + 1, 2 * half + 1, CV_8U));
  for (int y = 0; y < share.rows; ++y) {
    for (int x = 0; x < share.cols; ++x) {
      const float value = share.at<float>(y, x);
      if (value < kLeastVotes || value < highest.at<float>(y, x)) continue;
      found.push_back({cv::Point2d(x, y), radius, value});
    }
  }
}

/// Keeps the best of the circles that are about one centre.
std::vector<CellCandidate> distinct(std::vector<CellCandidate> all, int most) {
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  std::vector<CellCandidate> kept;
  for (const CellCandidate& candidate : all) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const CellCandidate& other) {
      return cv::norm(candidate.centre - other.centre) < 0.4 * std::max(candidate.radius, other.radius);
    });
    if (!known) kept.push_back(candidate);
    if (static_cast<int>(kept.size()) >= most) break;
  }
  return kept;
}

/// The frame reduced so that a circle of radius `low` keeps the smallest radius, and its edges.
struct Reduced {
  int level = -1;
  double scale = 1;
  std::vector<Edge> edges;

  void reduce(const Frame& frame, double low) {
    const int wanted = std::clamp(static_cast<int>(std::floor(std::log2(low / kSmallestRadius))), 0, 5);
    if (wanted == level) return;
    level = wanted;
    scale = std::ldexp(1, level);
    // Noise of the smoothed derivative: white noise falls with the pixels averaged; a floor for rest.
    edges = edgesOf(frame.level(level), std::max(0.25 * frame.noise() / scale, 3e-4));
  }
};

}  // namespace

std::vector<CellCandidate> findCellCandidates(const Frame& frame, double low, double high, int most) {
  std::vector<CellCandidate> all;
  Reduced reduced;
  for (double r = low; r < high; r *= kBinRatio) {
    reduced.reduce(frame, r);
    const double first = r / reduced.scale, last = first * kBinRatio, middle = std::sqrt(first * last);
    std::vector<CellCandidate> found;
    addMaxima(shareOf(votes(reduced.edges, frame.level(reduced.level).size(), first, last), middle), middle, found);
    for (const CellCandidate& candidate : found) {
      all.push_back(
          {Frame::fromLevel(candidate.centre, reduced.level), candidate.radius * reduced.scale, candidate.share});
    }
  }
  return distinct(std::move(all), most);
}

}  // namespace microinjection
