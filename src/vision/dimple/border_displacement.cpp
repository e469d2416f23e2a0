#include "vision/dimple/border_displacement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "vision/frame/robust_loss.h"

namespace microinjection {
namespace {

constexpr double kFirstLine = 3;   // px, from the needle's edge to the first line
constexpr double kLastLine = 0.6;  // of the radius: the last line
constexpr int kReweightings = 8;
constexpr double kBlurAlongNeedle = 1.5;  // px, standard deviation along the needle
constexpr double kDepthMargin = 6;        // px, that a depth may leave what the tip's place allows
constexpr double kDepthStep = 0.25;       // px, steps of the depth in the search
constexpr double kSteepestWindow = 2.5;   // px, around the best depth, for the steepest place of a line
constexpr double kTied = 3;               // neighbouring lines that the smoothing ties together
constexpr std::size_t kLeastLines = 12;
constexpr int kFirstWidthRow = 10, kLastWidthRow = 30;  // px behind the tip, where the needle's width is measured
constexpr int kWidestNeedle = 60;                       // px, half of it
constexpr double kClearEdge = 0.35;                     // of the clearest edge
constexpr double kEdgeOverNoise = 0.5;                  // of a pixel's noise: the mean of the rows has a fifth of it

/// Lines parallel to a needle, in its frame: `across` and `along` (px) from the tip, along towards the shaft.
class Lines {
 public:
  Lines(const Frame& frame, const CellBorder& border, const cv::Point2d& tip, double direction)
      : frame_(frame),
        border_(border),
        outline_(border.ellipse),
        tip_(tip),
        u_(std::cos(direction), std::sin(direction)) {}

  /// Where the line leaves the outline towards the shaft; none: it does not meet it.
  std::optional<double> crossing(double across) const {
    return outline_.exit(tip_ + across * v(), std::atan2(u_.y, u_.x));
  }

  /// Reads the lines at these distances from the axis, from `low` to `high` px beside the outline.
  void read(const std::vector<double>& across, double low, double high) {
    across_ = across;
    low_ = low;
    const int columns = static_cast<int>(high - low) + 1, rows = static_cast<int>(across.size());
    cv::Mat x(rows, columns, CV_32F), y(rows, columns, CV_32F), grey;
    seen_.assign(across.size(), false);
    for (int i = 0; i < rows; ++i) {
      const std::optional<double> place = crossing(across[i]);
      const cv::Point2d start = tip_ + across[i] * v() + (place.value_or(0) + low) * u_;
      seen_[i] =
          place && frame_.contains(start, kDepthMargin) && frame_.contains(start + (columns - 1) * u_, kDepthMargin);
      for (int k = 0; k < columns; ++k) {
        x.at<float>(i, k) = static_cast<float>(start.x + k * u_.x);
        y.at<float>(i, k) = static_cast<float>(start.y + k * u_.y);
      }
    }
    cv::remap(frame_.grey(), grey, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::GaussianBlur(grey, grey, cv::Size(11, 3), kBlurAlongNeedle, 0.7, cv::BORDER_REPLICATE);
    cv::Sobel(grey, slope_, CV_32F, 1, 0, 1, 0.5, 0, cv::BORDER_REPLICATE);
    if (border_.polarity == Polarity::kFalling) slope_ = -slope_;
    if (border_.polarity == Polarity::kEither) slope_ = cv::abs(slope_);
  }

  std::size_t size() const { return across_.size(); }
  double across(std::size_t i) const { return across_[i]; }
  bool isSeen(std::size_t i) const { return seen_[i]; }
  /// Steepness of line i where the outline is displaced by `displacement` px into the cell.
  double steepness(std::size_t i, double displacement) const {
    const double column = columnOf(displacement);
    const int k = std::clamp(static_cast<int>(column), 0, slope_.cols - 2);
    const float* row = slope_.ptr<float>(static_cast<int>(i));
    return row[k] + (column - k) * (row[k + 1] - row[k]);
  }
  /// Displacement at the steepest place within kSteepestWindow of another one; none: it is at the end.
  std::optional<double> steepest(std::size_t i, double displacement) const {
    const float* row = slope_.ptr<float>(static_cast<int>(i));
    const double middle = columnOf(displacement);
    const int first = std::max(1, static_cast<int>(std::ceil(middle - kSteepestWindow)));
    const int last = std::min(slope_.cols - 2, static_cast<int>(std::floor(middle + kSteepestWindow)));
    int best = -1;
    for (int k = first; k <= last; ++k) {
      if (row[k] > 0 && row[k] >= row[k - 1] && row[k] >= row[k + 1] && (best < 0 || row[k] > row[best])) best = k;
    }
    if (best < 0) return std::nullopt;
    const double bend = row[best - 1] - 2 * row[best] + row[best + 1];
    const double exact = best + (bend < 0 ? 0.5 * (row[best - 1] - row[best + 1]) / bend : 0);
    return border_.shift - low_ - exact;
  }

 private:
  cv::Point2d v() const { return {-u_.y, u_.x}; }
  double columnOf(double displacement) const { return border_.shift - displacement - low_; }

  const Frame& frame_;
  const CellBorder& border_;
  const Ellipse& outline_;
  cv::Point2d tip_, u_;
  std::vector<double> across_;
  std::vector<bool> seen_;
  double low_ = 0;
  cv::Mat slope_;  ///< CV_32F, a row for each line, towards the shaft
};

/// Displacement at a distance from the axis over that under the tip.
double shape(double half_width, double across) { return M_2_PI * std::asin(half_width / std::abs(across)); }

/// px, the depth from -kDepthMargin to `deepest` at which the outline is steepest.
double steepestDepth(const Lines& lines, double half_width, double deepest) {
  double depth = 0, most = 0;
  for (double d = -kDepthMargin; d <= deepest; d += kDepthStep) {
    double sum = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines.isSeen(i)) sum += lines.steepness(i, d * shape(half_width, lines.across(i)));
    }
    if (sum <= most) continue;
    most = sum;
    depth = d;
  }
  return depth;
}

struct Reading {
  double across, shape, displacement;

  /// Of the depth, and of the place and the slant of the undisturbed outline.
  Eigen::Vector3d row(double scale) const { return {shape, 1, across / scale}; }
};

/// Depth, place and slant by least squares with Tukey's weights; false when they cannot be told apart.
bool fit(const std::vector<Reading>& readings, double scale, Eigen::Vector3d& solution, double& deviation) {
  double spread = kSteepestWindow;
  Eigen::Matrix3d matrix;
  for (int round = 0; round < kReweightings; ++round) {
    matrix.setZero();
    Eigen::Vector3d right(0, 0, 0);
    for (const Reading& reading : readings) {
      const Eigen::Vector3d row = reading.row(scale);
      const double d = (reading.displacement - row.dot(solution)) / (RobustLoss::kTukey * spread);
      const double weight = std::abs(d) < 1 ? (1 - d * d) * (1 - d * d) : 0;
      matrix += weight * row * row.transpose();
      right += weight * reading.displacement * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-6)) return false;
    solution = solver.solve(right);
    std::vector<double> rest;
    for (const Reading& each : readings) rest.push_back(std::abs(each.displacement - each.row(scale).dot(solution)));
    std::nth_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2), rest.end());
    spread = std::max(0.1, 1.48 * rest[rest.size() / 2]);
  }
  deviation = spread * std::sqrt(kTied * matrix.inverse()(0, 0));
  return true;
}

/// Distance (px) from the middle of the outermost clear edge that both sides of a profile's slope have; else 0.
double symmetricEdge(const cv::Mat& slope, double noise) {
  // Both edges together: what is on one side only is not the needle's.
  std::vector<double> edge(kWidestNeedle);
  for (int k = 1; k < kWidestNeedle; ++k) {
    edge[k] = std::min(std::abs(slope.at<float>(kWidestNeedle + k)), std::abs(slope.at<float>(kWidestNeedle - k)));
    if (slope.at<float>(kWidestNeedle + k) * slope.at<float>(kWidestNeedle - k) > 0) edge[k] = 0;
  }
  const double limit = kClearEdge * *std::max_element(edge.begin(), edge.end());
  if (!(limit > kEdgeOverNoise * noise)) return 0;
  int last = kWidestNeedle - 2;
  while (last > 1 && !(edge[last] > limit && edge[last] >= edge[last - 1])) --last;
  return last;
}

}  // namespace

double needleHalfWidth(const Frame& frame, const cv::Point2d& tip, double direction) {
  const cv::Point2d u(std::cos(direction), std::sin(direction)), v(-u.y, u.x);
  constexpr int kColumns = 2 * kWidestNeedle + 1, kRows = kLastWidthRow - kFirstWidthRow + 1;
  cv::Mat x(kRows, kColumns, CV_32F), y(kRows, kColumns, CV_32F), grey, mean, slope;
  for (int row = 0; row < kRows; ++row) {
    for (int k = 0; k < kColumns; ++k) {
      const cv::Point2d point =
          tip + static_cast<double>(kFirstWidthRow + row) * u + static_cast<double>(k - kWidestNeedle) * v;
      if (!frame.contains(point)) return 0;
      x.at<float>(row, k) = static_cast<float>(point.x);
      y.at<float>(row, k) = static_cast<float>(point.y);
    }
  }
  cv::remap(frame.grey(), grey, x, y, cv::INTER_LINEAR);
  cv::reduce(grey, mean, 0, cv::REDUCE_AVG);
  cv::GaussianBlur(mean, mean, cv::Size(5, 1), 1, 0, cv::BORDER_REPLICATE);
  cv::Sobel(mean, slope, CV_32F, 1, 0, 1, 0.5, 0, cv::BORDER_REPLICATE);
  return symmetricEdge(slope, frame.noise());
}

BorderDisplacement findDisplacement(const Frame& frame, const CellBorder& border, const cv::Point2d& tip,
                                    double direction) {
  BorderDisplacement result;
  Lines lines(frame, border, tip, direction);
  const std::optional<double> crossing = lines.crossing(0);
  result.finding = Finding::notFound("the needle does not point at the cell");
  if (!crossing) return result;
  const double half_width = needleHalfWidth(frame, tip, direction);
  result.finding = Finding::notFound("the needle's edges are not clear");
  if (half_width <= 0) return result;
  const double radius = 0.5 * border.ellipse.meanDiameter(), last = kLastLine * radius;
  std::vector<double> across;
  for (double s = half_width + kFirstLine; s <= last; ++s) across.insert(across.end(), {-s, s});
  std::sort(across.begin(), across.end());
  result.finding = Finding::notFound("the outline beside the needle is not clear");
  if (across.size() < kLeastLines) return result;
  const double deepest = std::max(0.0, *crossing) + kDepthMargin;
  lines.read(across, -deepest - kDepthMargin, 2 * kDepthMargin);
  const double depth = steepestDepth(lines, half_width, deepest);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double g = shape(half_width, lines.across(i));
    const std::optional<double> place = lines.isSeen(i) ? lines.steepest(i, depth * g) : std::nullopt;
    if (place) readings.push_back({lines.across(i), g, *place});
  }
  if (readings.size() < kLeastLines || 2 * readings.size() < lines.size()) return result;
  Eigen::Vector3d solution(depth, 0, 0);
  if (!fit(readings, last, solution, result.deviation)) return result;
  result.depth = solution[0];
  result.gap = solution[1] - *crossing;
  result.finding = Finding::found();
  return result;
}

}  // namespace microinjection
