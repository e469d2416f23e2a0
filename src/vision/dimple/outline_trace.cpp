#include "vision/dimple/outline_trace.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr int kTraceRays = 240;
constexpr double kFacing = 1.45;                        // rad, half of the sector that the needle may displace
constexpr double kDeepestDimple = 0.4;                  // of the radius, a dimple
constexpr double kAbove = 0.06;                         // of the radius, that the ellipse may be too low
constexpr double kElsewhere = 4;                        // px, from the ellipse beside this sector
constexpr double kOutwardsPerPixel = 0.012;             // strength of a place over one that is 1 px deeper
constexpr double kFullContrast = 0.6;                   // of the border's contrast, that counts as a full border
constexpr int kMostChange = 7;                          // columns from ray to ray
constexpr double kAcrossStep = 0.5, kAcrossBlur = 1.2;  // px, across the path
constexpr double kWidestRim = 14;                       // px, from flank to flank
constexpr double kSameRim = 0.5;                        // of the usual rim, that another one may differ from it
constexpr double kLeastFalling = 0.3;                   // of the rising slope, the falling one of a rim
constexpr double kLeastSlope = 0.3;                     // of the usual slope, of a clear flank
constexpr int kPathNeighbours = 2;                      // neighbours on both sides that give the path's direction

/// Profiles across a path: derivatives outwards, a row for each of its points.
class Profiles {
 public:
  Profiles(const Frame& frame, const std::vector<cv::Point2d>& path, double inside, double outside) : low_(-inside) {
    const int rows = static_cast<int>(path.size()), columns = static_cast<int>((inside + outside) / kAcrossStep) + 1;
    cv::Mat x(rows, columns, CV_32F), y(rows, columns, CV_32F), grey;
    for (int i = 0; i < rows; ++i) {
      cv::Point2d along = path[(i + kPathNeighbours) % rows] - path[(i + rows - kPathNeighbours) % rows];
      const double length = std::max(cv::norm(along), 1e-9);
      cv::Point2d normal(along.y / length, -along.x / length);
      // The path turns from x towards y: outwards is on its left in the image.
      normals_.push_back(normal);
      seen_.push_back(frame.contains(path[i] + low_ * normal, 1) && frame.contains(path[i] + outside * normal, 1));
      for (int k = 0; k < columns; ++k) {
        const cv::Point2d place = path[i] + (low_ + k * kAcrossStep) * normal;
        x.at<float>(i, k) = static_cast<float>(place.x);
        y.at<float>(i, k) = static_cast<float>(place.y);
      }
    }
    cv::remap(frame.grey(), grey, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    cv::GaussianBlur(grey, grey, cv::Size(13, 1), kAcrossBlur / kAcrossStep, 0, cv::BORDER_REPLICATE);
    cv::Sobel(grey, slope_, CV_32F, 1, 0, 1, 0.5 / kAcrossStep, 0, cv::BORDER_REPLICATE);
  }

  bool isSeen(int i) const { return seen_[i]; }
  const cv::Point2d& normal(int i) const { return normals_[i]; }
  /// Steepest local place (px from the path) within [low, high] of slopes of this sign; its slope, or 0.
  double steepest(int i, double sign, double low, double high, double& place) const {
    const float* row = slope_.ptr<float>(i);
    const int first = std::max(1, static_cast<int>(std::ceil((low - low_) / kAcrossStep)));
    const int last = std::min(slope_.cols - 2, static_cast<int>(std::floor((high - low_) / kAcrossStep)));
    int best = -1;
    for (int k = first; k <= last; ++k) {
      const double here = sign * row[k];
      if (here <= 0 || here < sign * row[k - 1] || here < sign * row[k + 1]) continue;
      if (best < 0 || here > sign * row[best]) best = k;
    }
    if (best < 0) return 0;
    place = low_ + exact(row, best) * kAcrossStep;
    return std::abs(row[best]);
  }

  /// Nearest steepest place (px from the path) from `from` down to `to` whose slope of this sign is above a limit.
  bool nearest(int i, double sign, double from, double to, double limit, double& place) const {
    const float* row = slope_.ptr<float>(i);
    const int last = std::max(1, static_cast<int>(std::ceil((to - low_) / kAcrossStep)));
    for (int k = std::min(slope_.cols - 2, static_cast<int>((from - low_) / kAcrossStep)); k >= last; --k) {
      const double here = sign * row[k];
      if (here < limit || here < sign * row[k - 1] || here < sign * row[k + 1]) continue;
      place = low_ + exact(row, k) * kAcrossStep;
      return true;
    }
    return false;
  }

 private:
  static double exact(const float* row, int k) {
    const double bend = row[k - 1] - 2 * row[k] + row[k + 1];
    return bend == 0 ? k : k + std::clamp(0.5 * (row[k - 1] - row[k + 1]) / bend, -0.5, 0.5);
  }

  double low_;
  std::vector<cv::Point2d> normals_;
  std::vector<bool> seen_;
  cv::Mat slope_;
};

}  // namespace

bool NeedleShadow::hides(const cv::Point2d& point) const {
  const cv::Point2d d = point - axis.tip;
  const double along = d.dot(axis.along()), across = std::abs(d.dot(axis.across()));
  return across < half_width + taper * std::max(0.0, along) + kBesideNeedle;
}

std::vector<cv::Point2d> findOutline(const Frame& frame, const CellBorder& border, const NeedleShadow& needle) {
  const Ellipse& ellipse = border.ellipse;
  const double radius = 0.5 * ellipse.meanDiameter(), low = -kDeepestDimple * radius, high = kAbove * radius;
  const int columns = static_cast<int>(high - low) + 1;
  const PolarMap map(frame, ellipse, {low, low + columns - 1, columns, kTraceRays}, 1.5);
  const double facing = needle.axis.direction;
  // The border is as clear in the dimple as elsewhere; the ooplasm's, which is clearer, counts no more.
  cv::Mat strength = borderStrength(map, border.polarity, std::max(kFullContrast * border.contrast, frame.noise()));
  for (int ray = 0; ray < kTraceRays; ++ray) {
    const bool faces = angleBetween(map.direction(ray), facing) < kFacing;
    for (int i = 0; i < columns; ++i) {
      float& here = strength.at<float>(ray, i);
      if (!faces && std::abs(low + i) > kElsewhere) here = -5;
      // The needle's own walls are not the cell's border, nor is what is seen below its tip.
      if (faces && needle.hides(map.point(ray, i))) here = 0;
      // Where the dent is, is not taken from the tip, which may be wrong. Of two borders the outer counts more.
      here += static_cast<float>(kOutwardsPerPixel * i);
    }
  }
  const ClosedPath path = closedPath(strength, kMostChange);
  std::vector<cv::Point2d> points;
  for (int ray = 0; ray < kTraceRays; ++ray) points.push_back(map.point(ray, path.column[ray]));
  return points;
}

std::vector<cv::Point2d> outlineOf(const DentedEllipse& dented, const NeedleAxis& axis) {
  std::vector<cv::Point2d> points;
  for (int ray = 0; ray < kTraceRays; ++ray) {
    const double angle = 2 * M_PI * ray / kTraceRays;
    cv::Point2d point =
        dented.ellipse.centre + dented.ellipse.radius(angle) * cv::Point2d(std::cos(angle), std::sin(angle));
    const cv::Point2d d = point - axis.tip;
    if (angleBetween(angle, axis.direction) < kFacing)
      point -= dented.displacement(axis, d.dot(axis.across())) * axis.along();
    points.push_back(point);
  }
  return points;
}

std::vector<BorderPoint> traceOutline(const Frame& frame, const CellBorder& border, const NeedleShadow& needle,
                                      const std::vector<cv::Point2d>& path, double flank, double window) {
  const Profiles profiles(frame, path, window + kWidestRim + 2, window + flank + 2);
  const double sign = border.polarity == Polarity::kFalling ? -1 : 1;
  std::vector<BorderPoint> points(path.size());
  std::vector<double> slope(path.size(), 0.0), outer(path.size(), 0.0), rim(path.size(), 0.0), slopes, rims;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const int row = static_cast<int>(i);
    const cv::Point2d away = path[i] - border.ellipse.centre;
    points[i].normal = profiles.normal(row);
    points[i].facing = angleBetween(std::atan2(away.y, away.x), needle.axis.direction) < kFacing;
    slope[i] = profiles.steepest(row, sign, flank - window, flank + window, outer[i]);
    points[i].trusted = slope[i] > 0 && profiles.isSeen(row) && !(points[i].facing && needle.hides(path[i]));
    if (!points[i].trusted) continue;
    slopes.push_back(slope[i]);
    double inner = 0;
    if (border.place > 0 &&
        profiles.nearest(row, -sign, outer[i] - 1, outer[i] - kWidestRim, kLeastFalling * slope[i], inner)) {
      rim[i] = outer[i] - inner;
      rims.push_back(rim[i]);
    }
  }
  const double usual = upperMedian(slopes), usual_rim = 2 * rims.size() > slopes.size() ? upperMedian(rims) : 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool own = std::abs(rim[i] - usual_rim) < kSameRim * usual_rim;
    points[i].place = path[i] + (outer[i] - border.place * (own ? rim[i] : usual_rim)) * points[i].normal;
    points[i].trusted = points[i].trusted && slope[i] > kLeastSlope * usual;
  }
  return points;
}

}  // namespace microinjection
