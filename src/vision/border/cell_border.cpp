#include "vision/border/cell_border.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/border/border_dent.h"

namespace microinjection {
namespace {

constexpr double kFullBorder = 6;  // of the slopes' scale, a slope that counts as a full border
constexpr int kMostClimb = 8;      // columns
constexpr double kBorder = 0.5;    // strength of a ray that sees a border
constexpr double kFoundCoverage = 0.3;
constexpr int kIndependentRays = 3;  // neighbours that the smoothing ties together

void forbid(const PolarMap& map, const BorderBand& band, cv::Mat& strength) {
  for (int ray = 0; ray < map.rays(); ++ray) {
    const double angle = map.direction(ray);
    const double low = band.inner.semi_axes[1] > 0 ? map.column(ray, band.inner.reach(map.centre(), angle)) : -1;
    const double high =
        band.outer.semi_axes[1] > 0 ? map.column(ray, band.outer.reach(map.centre(), angle)) : map.columns();
    for (int i = 0; i < map.columns(); ++i) {
      if (i < low || i > high) strength.at<float>(ray, i) = kForbidden;
    }
  }
}

double steepness(const PolarMap& map, int ray, int column, Polarity polarity) {
  const double slope = map.slope().at<float>(ray, column);
  return polarity == Polarity::kEither ? std::abs(slope) : polarity == Polarity::kRising ? slope : -slope;
}

/// Column of the steepest slope uphill from a column, or -1 when that leads out of the map: the foot
/// of a border that is outside of it.
int climb(const PolarMap& map, int ray, int column, Polarity polarity) {
  for (int round = 0; round < kMostClimb; ++round) {
    if (column < 1 || column + 1 >= map.columns()) return -1;
    const double here = steepness(map, ray, column, polarity);
    const double low = steepness(map, ray, column - 1, polarity), high = steepness(map, ray, column + 1, polarity);
    if (here >= low && here >= high) break;
    column += low > high ? -1 : 1;
  }
  return column;
}

/// Place of the steepest slope beside a column, by a parabola.
double steepest(const PolarMap& map, int ray, int column, Polarity polarity) {
  if (column < 1 || column + 1 >= map.columns()) return column;
  const auto at = [&](int i) { return steepness(map, ray, i, polarity); };
  const double a = at(column - 1), b = at(column), c = at(column + 1), bend = a - 2 * b + c;
  return bend < 0 ? column + std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : column;
}

/// Mean slope along the ellipse, and that over its standard error.
void weigh(const PolarMap& map, CellBorder& border) {
  double sum = 0, square = 0;
  int count = 0;
  for (int ray = 0; ray < map.rays(); ++ray) {
    const double radius = border.ellipse.reach(map.centre(), map.direction(ray));
    const int column = static_cast<int>(std::lround(map.column(ray, radius)));
    if (column < 0 || column >= map.columns() || map.valid().at<unsigned char>(ray, column) == 0) continue;
    double slope = map.slope().at<float>(ray, column);
    if (border.polarity == Polarity::kFalling) slope = -slope;
    if (border.polarity == Polarity::kEither) slope = std::abs(slope);
    sum += slope;
    square += slope * slope;
    ++count;
  }
  if (count < 3 * kIndependentRays) return;
  const double mean = sum / count, variance = std::max(square / count - mean * mean, 1e-14);
  border.contrast = mean / map.step();
  border.significance = mean / std::sqrt(variance * kIndependentRays / count);
}

struct Points {
  std::vector<cv::Point2d> all;
  int seen = 0;  ///< rays within the image
  double mean_radius = 0;
  double strength = 0;
  double consistency = 0;
};

Points pointsOf(const PolarMap& map, const ClosedPath& path, const cv::Mat& strength, Polarity polarity) {
  Points points;
  for (int ray = 0; ray < map.rays(); ++ray) {
    const int column = path.column[ray];
    if (map.valid().at<unsigned char>(ray, column) == 0 || map.slope().at<float>(ray, column) == 0) continue;
    ++points.seen;
    const int peak = climb(map, ray, column, polarity);
    if (peak < 0) continue;
    const double exact = steepest(map, ray, peak, polarity);
    points.all.push_back(map.point(ray, exact));
    points.mean_radius += map.radius(ray, exact);
    points.strength += std::max(strength.at<float>(ray, column), -0.3F);
    points.consistency += strength.at<float>(ray, column) > kBorder ? 1 : 0;
  }
  const double count = std::max<double>(1, static_cast<double>(points.all.size()));
  points.mean_radius /= count;
  points.strength /= count;
  points.consistency /= count;
  return points;
}

}  // namespace

double outsideShare(const Frame& frame, const Ellipse& ellipse) {
  int outside = 0;
  constexpr int kPoints = 180;
  for (int i = 0; i < kPoints; ++i) outside += frame.contains(ellipse.at(2 * M_PI * i / kPoints)) ? 0 : 1;
  return static_cast<double>(outside) / kPoints;
}

Ellipse scaled(const Ellipse& ellipse, double factor) {
  return {ellipse.centre, ellipse.semi_axes * factor, ellipse.angle};
}

CellBorder findBorder(const Frame& frame, const PolarMap& map, Polarity polarity, const BorderBand& band, double scale,
                      double tolerance) {
  CellBorder border;
  border.polarity = polarity;
  border.finding = Finding::notFound("no closed border of the size that is asked for");
  cv::Mat strength = borderStrength(map, polarity, kFullBorder * scale);
  forbid(map, band, strength);
  cv::Mat preferred = strength.clone();
  for (int i = 0; band.outwards != 0 && i < map.columns(); ++i) preferred.col(i) += band.outwards * i / map.columns();
  const ClosedPath path = closedPath(preferred, band.most_change);
  const Points points = pointsOf(map, path, strength, polarity);
  border.strength = points.strength;
  border.consistency = points.consistency;
  const Ellipse start{map.centre(), {points.mean_radius, points.mean_radius}, 0};
  const EllipseFit fit = fitEllipse(points.all, start, tolerance);
  if (!fit.valid) return border;
  border.ellipse = fit.ellipse;
  border.covariance = fit.covariance;
  border.residual = fit.residual;
  border.points = points.all;
  border.inlier = fit.inlier;
  const auto inliers = std::count(fit.inlier.begin(), fit.inlier.end(), true);
  border.outside = outsideShare(frame, fit.ellipse);
  // Directions whose border the image does not show count as not covered, once they are many.
  const double seen = std::max<double>(points.seen, 0.3 * map.rays());
  border.coverage = static_cast<double>(inliers) / seen;
  weigh(map, border);
  if (border.coverage >= kFoundCoverage) border.finding = Finding::found();
  return border;
}

namespace {

constexpr double kRimShare = 0.4;  // of the rising slope, the least falling one of a rim

/// Mean slope of each column over the rays that see the border.
std::vector<double> meanSlope(const PolarMap& map) {
  std::vector<double> mean(map.columns(), 0.0);
  for (int i = 0; i < map.columns(); ++i) {
    // The middle half of the rays: what touches the cell in some directions does not count.
    std::vector<float> slopes;
    for (int ray = 0; ray < map.rays(); ++ray) {
      if (map.valid().at<unsigned char>(ray, i) != 0) slopes.push_back(map.slope().at<float>(ray, i));
    }
    if (slopes.size() < 8) continue;
    std::sort(slopes.begin(), slopes.end());
    const std::size_t quarter = slopes.size() / 4;
    for (std::size_t k = quarter; k < slopes.size() - quarter; ++k) mean[i] += slopes[k];
    mean[i] /= static_cast<double>(slopes.size() - 2 * quarter);
  }
  return mean;
}

/// Column of the rim's falling flank, or -1 when there is no rim.
int fallingFlank(const std::vector<double>& slope, int rising, int widest) {
  int falling = -1;
  double most = -kRimShare * slope[rising];
  for (int i = std::max(1, rising - widest); i < rising; ++i) {
    if (slope[i] >= most) continue;
    falling = i;
    most = slope[i];
  }
  // A minimum at the end of the range belongs to something further inside.
  return falling > std::max(1, rising - widest) ? falling : -1;
}

int steepestColumn(const std::vector<double>& slope, int first, int last) {
  const auto begin = slope.begin() + first;
  return first + static_cast<int>(std::max_element(begin, slope.begin() + last) - begin);
}

/// The steepest column of the run of columns about one in which the border is a full one: along that run the strength
/// does not tell. In a drawn image, whose usual slope is nothing, the run is the whole flank.
int steepestOfRun(const PolarMap& map, const cv::Mat& strength, int ray, int column, Polarity polarity) {
  const float* row = strength.ptr<float>(ray);
  int best = column;
  for (const int way : {-1, 1}) {
    for (int i = column; i >= 0 && i < map.columns() && row[i] >= 1; i += way) {
      if (steepness(map, ray, i, polarity) > steepness(map, ray, best, polarity)) best = i;
    }
  }
  return best;
}

/// A path within `half` columns of a column, to a fraction of a column; negative where not seen.
std::vector<double> flankPath(const PolarMap& map, Polarity polarity, int column, int half, double scale) {
  cv::Mat strength = borderStrength(map, polarity, kFullBorder * scale);
  for (int i = 0; i < map.columns(); ++i) {
    if (std::abs(i - column) > half) strength.col(i).setTo(kForbidden);
  }
  const ClosedPath path = closedPath(strength, 1);
  std::vector<double> exact(map.rays(), -1);
  for (int ray = 0; ray < map.rays(); ++ray) {
    const int i = steepestOfRun(map, strength, ray, path.column[ray], polarity);
    if (map.valid().at<unsigned char>(ray, i) != 0 && map.slope().at<float>(ray, i) != 0) {
      exact[ray] = steepest(map, ray, i, polarity);
    }
  }
  return exact;
}

}  // namespace

CellBorder refineBorder(const Frame& frame, const CellBorder& coarse, const BorderRim& rim, double window, double blur,
                        int rays) {
  const double step = std::max(0.5, blur / 3), low = -window - rim.widest, high = window;
  const int columns = static_cast<int>(std::ceil((high - low) / step)) + 1;
  const PolarMap map(frame, coarse.ellipse, {low, low + (columns - 1) * step, columns, rays}, blur / step);
  const int flank = static_cast<int>(std::lround(-low / step)), half = std::max(2, static_cast<int>(window / step));
  const double scale = slopeScale(map, 0, columns);
  std::vector<double> place = flankPath(map, coarse.polarity, flank, half, scale);
  CellBorder fine = coarse;
  fine.points.clear();
  fine.rim = fine.shift = 0;
  fine.place = rim.place;
  if (rim.widest > 0 && coarse.polarity == Polarity::kRising) {
    const std::vector<double> slope = meanSlope(map);
    const int rising = steepestColumn(slope, std::max(0, flank - half), std::min(columns, flank + half + 1));
    const int falling = fallingFlank(slope, rising, static_cast<int>(rim.widest / step));
    if (falling >= 0) {
      const int reach = std::max(2, std::min(half, (rising - falling) / 2));
      place = flankPath(map, Polarity::kRising, rising, reach, scale);
      const std::vector<double> inner = flankPath(map, Polarity::kFalling, falling, reach, scale);
      for (int ray = 0; ray < rays; ++ray) place[ray] -= rim.place * (place[ray] - inner[ray]);
      fine.rim = (rising - falling) * step;
      fine.shift = rim.place * fine.rim;
    }
  }
  for (int ray = 0; ray < rays; ++ray) {
    if (place[ray] > 0) fine.points.push_back(map.point(ray, place[ray]));
  }
  const double tolerance = std::max(1.0, 0.01 * coarse.ellipse.meanDiameter());
  EllipseFit fit = fitEllipse(fine.points, coarse.ellipse, tolerance);
  if (!fit.valid) return coarse;
  // A border that should have a dark rim and shows none is not clear enough to tell a dent.
  if (rim.widest == 0 || fine.rim > 0) fit = withoutDents(fine.points, fit, tolerance);
  fine.ellipse = fit.ellipse;
  fine.covariance = fit.covariance;
  fine.residual = fit.residual;
  fine.inlier = fit.inlier;
  fine.coverage = static_cast<double>(std::count(fit.inlier.begin(), fit.inlier.end(), true)) /
                  std::max(static_cast<double>(fine.points.size()), 0.3 * rays);
  fine.outside = outsideShare(frame, fit.ellipse);
  return fine;
}

double diameterDeviation(const CellBorder& border) {
  return std::sqrt(border.covariance(2, 2) + kModelDeviation * kModelDeviation);
}

double borderScore(const CellBorder& border) {
  if (!border.finding.hasValues()) return 0;
  const double bonus = border.polarity == Polarity::kFalling ? 0.7 : 1;
  return bonus * border.coverage * std::max(border.strength, 0.0) * border.consistency * (1 - border.outside);
}

}  // namespace microinjection
