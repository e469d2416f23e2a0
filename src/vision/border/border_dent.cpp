#include "vision/border/border_dent.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kMostDents = 3;
constexpr int kRun = 45;                             // share 1 / n of the border: the shortest dent
constexpr double kLeastDent = 0.7, kOffEllipse = 3;  // px; of the median distance: what is off the ellipse
constexpr double kLeastRest = 0.45;                  // of the points, that an ellipse needs
constexpr double kDentFlanks[] = {0.17, 0.4, 0.65};  // rad to both sides of a dent, that it may reach
constexpr double kBetter = 0.6;                      // of the residual, that leaving dents out must leave at most
constexpr double kAsGood = 1.15;                     // of the smallest residual, one that is as good

double directionOf(const cv::Point2d& point, const Ellipse& ellipse) {
  return std::atan2(point.y - ellipse.centre.y, point.x - ellipse.centre.x);
}

double medianDistance(const std::vector<cv::Point2d>& points, const Ellipse& ellipse) {
  std::vector<double> distances;
  for (const cv::Point2d& point : points) distances.push_back(std::abs(ellipse.distance(point)));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

struct Dent {
  double middle = 0, half = 0;  ///< rad
};

/// The longest run of neighbours off the ellipse, among the points that are not left out yet.
bool findDent(const std::vector<cv::Point2d>& points, const std::vector<bool>& left_out, const Ellipse& ellipse,
              double limit, Dent& dent) {
  const int count = static_cast<int>(points.size());
  int longest = 0, end = 0;
  for (int i = 0, run = 0; i < 2 * count && run < count; ++i) {
    const bool off = !left_out[i % count] && std::abs(ellipse.distance(points[i % count])) > limit;
    run = off ? run + 1 : 0;
    if (run <= longest) continue;
    longest = run;
    end = i;
  }
  if (longest < std::max(3, count / kRun)) return false;
  const double first = directionOf(points[(end - longest + 1) % count], ellipse);
  const double span = std::remainder(directionOf(points[end % count], ellipse) - first, 2 * M_PI);
  dent = {first + span / 2, std::abs(span) / 2};
  return true;
}

}  // namespace

EllipseFit withoutDents(const std::vector<cv::Point2d>& points, const EllipseFit& fit, double tolerance) {
  EllipseFit best = fit;
  std::vector<bool> left_out(points.size(), false);
  bool any = false;
  for (int round = 0; round < kMostDents; ++round) {
    const double limit = std::max(kLeastDent, kOffEllipse * medianDistance(points, best.ellipse));
    Dent dent;
    if (!findDent(points, left_out, best.ellipse, limit, dent)) break;
    std::vector<EllipseFit> fits;
    std::vector<std::vector<bool>> masks;
    std::vector<double> residuals;
    for (const double beside : kDentFlanks) {
      std::vector<bool> mask = left_out;
      std::vector<cv::Point2d> rest;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (angleBetween(directionOf(points[i], best.ellipse), dent.middle) < dent.half + beside) mask[i] = true;
        if (!mask[i]) rest.push_back(points[i]);
      }
      if (rest.size() < kLeastRest * points.size()) break;
      fits.push_back(fitEllipse(rest, best.ellipse, tolerance));
      if (!fits.back().valid) break;
      masks.push_back(mask);
      residuals.push_back(medianDistance(rest, fits.back().ellipse));
    }
    if (residuals.empty()) break;
    const double least = *std::min_element(residuals.begin(), residuals.end());
    const auto chosen = static_cast<std::size_t>(
        std::find_if(residuals.begin(), residuals.end(), [&](double r) { return r <= kAsGood * least; }) -
        residuals.begin());
    best = fits[chosen];
    left_out = masks[chosen];
    any = true;
  }
  if (!any || best.residual > kBetter * fit.residual) return fit;
  best.inlier.clear();
  for (const cv::Point2d& point : points) best.inlier.push_back(std::abs(best.ellipse.distance(point)) <= tolerance);
  return best;
}

}  // namespace microinjection
