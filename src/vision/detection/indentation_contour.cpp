#include "vision/detection/indentation_contour.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kFacing = 1.1;    // rad, half of the sector that faces the needle
constexpr double kDeepest = 0.55;  // of the radius, a dimple
constexpr double kFitted = 0.12;   // of the radius, half of the dimple's middle that gives the parabola, at least
constexpr double kBelowTip = 3;    // px, that the border may be deeper than the tip
constexpr double kOutwards = 0.3;  // strength of the outermost column over the innermost
constexpr float kSeen = 0.45F;     // strength of a border that is seen
constexpr double kTouches = 4;     // px, of the contour from the tip that touches it
constexpr double kThinnest = 14, kThickest = 20;  // px, of the needle near its tip
constexpr int kRays = 240;

double angleBetween(double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); }

struct Seen {
  double across, along;  ///< px, from the tip, in the needle's frame: along is positive towards the shaft
};

/// Place of the border along the needle at `across` = 0, by a parabola with Tukey's weights.
bool parabola(const std::vector<Seen>& points, double& value, double& deviation) {
  if (points.size() < 8) return false;
  Eigen::Vector3d coefficients(0, 0, 0);
  double scale = 1e3;
  Eigen::Matrix3d matrix;
  for (int round = 0; round < 8; ++round) {
    matrix.setZero();
    Eigen::Vector3d right(0, 0, 0);
    for (const Seen& seen : points) {
      const Eigen::Vector3d row(1, seen.across, seen.across * seen.across);
      const double d = (seen.along - row.dot(coefficients)) / (4.685 * scale);
      const double weight = round == 0 ? 1 : std::abs(d) < 1 ? (1 - d * d) * (1 - d * d) : 0;
      matrix += weight * row * row.transpose();
      right += weight * seen.along * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-14)) return false;
    coefficients = solver.solve(right);
    std::vector<double> rest;
    for (const Seen& seen : points) {
      rest.push_back(
          std::abs(seen.along - coefficients.dot(Eigen::Vector3d(1, seen.across, seen.across * seen.across))));
    }
    std::nth_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2), rest.end());
    scale = std::max(0.1, 1.48 * rest[rest.size() / 2]);
  }
  value = coefficients[0];
  deviation = scale * std::sqrt(std::max(0.0, matrix.inverse()(0, 0)));
  return true;
}

}  // namespace

Indentation findIndentation(const Frame& frame, const CellBorder& border, const cv::Point2d& tip, double direction,
                            double width) {
  Indentation result;
  result.finding = Finding::notFound("there is no outline of a cell");
  if (!border.finding.hasValues()) return result;
  if (border.ellipse.distance(tip) > kTouches) {
    result.finding = Finding::notFound("the tip is outside of the cell's outline: there is no dimple");
    return result;
  }
  const double radius = 0.5 * border.ellipse.meanDiameter(), low = -kDeepest * radius, high = 0.06 * radius;
  const int columns = static_cast<int>(high - low) + 1;
  const PolarMap map(frame, border.ellipse, {low, low + columns - 1, columns, kRays}, 1.5);
  const double facing = std::atan2(tip.y - border.ellipse.centre.y, tip.x - border.ellipse.centre.x);
  // The border is as clear in the dimple as elsewhere; the ooplasm's, which is clearer, counts no more.
  cv::Mat strength = borderStrength(map, border.polarity, std::max(border.contrast, frame.noise()));
  const cv::Point2d u(std::cos(direction), std::sin(direction)), v(-u.y, u.x);
  for (int ray = 0; ray < kRays; ++ray) {
    if (angleBetween(map.direction(ray), facing) > kFacing) {
      // Elsewhere the border is on its ellipse.
      for (int i = 0; i < columns; ++i) {
        if (std::abs(low + i) > 4) strength.at<float>(ray, i) = -5;
      }
      continue;
    }
    for (int i = 0; i < columns; ++i) {
      const cv::Point2d d = map.point(ray, i) - tip;
      const double along = d.dot(u), across = std::abs(d.dot(v));
      float& here = strength.at<float>(ray, i);
      // The needle's own walls are not the cell's border, which passes below the tip.
      if (along > -kTouches && across < width) here = 0;
      if (across < 0.5 * width && std::abs(along) > kTouches) here = kForbidden;
      // The ooplasm's border is deeper than the needle is. Of what is left the outer border counts more.
      if (along < -kBelowTip) here = kForbidden;
      here += static_cast<float>(kOutwards * i / columns);
    }
  }
  const ClosedPath path = closedPath(strength, 6);
  std::vector<Seen> seen;
  for (int ray = 0; ray < kRays; ++ray) {
    if (angleBetween(map.direction(ray), facing) > kFacing) continue;
    const int column = path.column[ray];
    if (map.valid().at<unsigned char>(ray, column) == 0 || strength.at<float>(ray, column) < kSeen) continue;
    const cv::Point2d point = map.point(ray, column - border.shift);
    result.contour.push_back(point);
    const cv::Point2d d = point - tip;
    if (std::abs(d.dot(v)) < std::max(2.5 * width, kFitted * radius) && std::abs(d.dot(v)) > 0.5 * width)
      seen.push_back({d.dot(v), d.dot(u)});
  }
  double place = 0;
  result.finding = Finding::notFound("the outline under the needle is not clear");
  if (!parabola(seen, place, result.deviation)) return result;
  // The needle hides the border that it touches: where the contour on both sides of it leads to the
  // tip, the tip is the deepest place.
  const bool touches = std::abs(place) < std::max(kTouches, 3 * result.deviation);
  result.deepest = touches ? tip : tip + place * u;
  // The border's ellipse leaves the dimple out. From the deepest place back along the needle; 0 outside of it.
  result.depth = border.ellipse.reach(result.deepest, direction);
  result.finding = touches ? Finding::found()
                           : Finding::uncertain("the outline under the needle is not at the tip: it may not touch");
  return result;
}

Indentation findIndentation(const Frame& frame, const CellBorder& border, const PipetteDetection& needle) {
  Indentation result;
  result.finding = Finding::notFound("there is no needle that could indent the cell");
  if (!needle.finding.hasValues()) return result;
  // The half width is that of the shaft a little behind the tip.
  const double width = std::clamp(2 * needle.half_width, kThinnest, kThickest);
  result = findIndentation(frame, border, needle.end, needle.direction, width);
  if (border.finding.hasValues()) result.displacement = findDisplacement(frame, border, needle.end, needle.direction);
  const Eigen::Vector2d along(std::cos(needle.direction), std::sin(needle.direction));
  result.deviation = std::hypot(result.deviation, std::sqrt(along.dot(needle.covariance * along)));
  if (result.finding.isFound() && !needle.finding.isFound()) result.finding = needle.finding;
  return result;
}

}  // namespace microinjection
