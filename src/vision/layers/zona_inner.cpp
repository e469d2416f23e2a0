#include "vision/layers/zona_inner.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/frame/robust_loss.h"

namespace microinjection {
namespace {

constexpr int kZonaRays = 240;
constexpr double kRayStep = 0.5, kRayBlur = 1.2;           // px, along the rays
constexpr double kRimMargin = 0.5;                         // px outside of the ooplasm's rim
constexpr double kOuterMargin = 5;                         // px inside of the outer border, that its own line takes
constexpr double kFullLine = 5;                            // of the scale, a curvature that counts as a full line
constexpr double kLeastRayShare = 0.12, kSureShare = 0.2;  // of the rays, that show the line
constexpr double kLeastLineStrength = 0.3, kSureStrength = 0.45;  // mean over them
constexpr double kBestRatio = 1.25;                               // of the strength to that of the next best thickness
constexpr double kNeighbour = 4;                                  // px, thicknesses that are the same line

/// Curvature of the grey value along the rays, positive on a dark line, relative to its usual size
/// and cut; 0 where the ooplasm's rim covers it.
cv::Mat lineStrength(const Frame& frame, const PolarMap& map, const CellBorder& ooplasm, cv::Mat& visible) {
  const cv::Mat kernel = (cv::Mat_<float>(1, 3) << -0.5F, 0, 0.5F);
  cv::Mat bend;
  cv::filter2D(map.slope(), bend, CV_32F, kernel, cv::Point(-1, -1), 0, cv::BORDER_REPLICATE);
  visible = cv::Mat::zeros(bend.size(), CV_8U);
  std::vector<float> sizes;
  for (int ray = 0; ray < map.rays(); ++ray) {
    const double rim = ooplasm.ellipse.reach(map.centre(), map.direction(ray)) + ooplasm.shift + kRimMargin;
    for (int i = 0; i < map.columns(); ++i) {
      if (map.valid().at<unsigned char>(ray, i) == 0 || map.radius(ray, i) < rim) continue;
      visible.at<unsigned char>(ray, i) = 255;
      sizes.push_back(std::abs(bend.at<float>(ray, i)));
    }
  }
  bend.setTo(0, visible == 0);
  if (sizes.size() < 100) return bend;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  const double scale = std::max<double>(sizes[sizes.size() / 2], 0.02 * frame.noise());
  bend /= kFullLine * scale;
  return cv::min(cv::max(bend, -0.3), 1.0);
}

/// Mean strength of each column over the rays that show it, and how many these are.
void columnMeans(const cv::Mat& strength, const cv::Mat& visible, std::vector<double>& mean,
                 std::vector<double>& share) {
  for (int i = 0; i < strength.cols; ++i) {
    double sum = 0;
    int count = 0;
    for (int ray = 0; ray < strength.rows; ++ray) {
      if (visible.at<unsigned char>(ray, i) == 0) continue;
      sum += strength.at<float>(ray, i);
      ++count;
    }
    mean.push_back(count > 0 ? sum / count : 0);
    share.push_back(static_cast<double>(count) / strength.rows);
  }
}

struct LinePlace {
  double direction, column;
};

/// The line's place on each ray that shows it within `half` columns.
std::vector<LinePlace> placesOf(const PolarMap& map, const cv::Mat& strength, const cv::Mat& visible, int column,
                                int half) {
  std::vector<LinePlace> places;
  for (int ray = 0; ray < map.rays(); ++ray) {
    int best = -1;
    for (int i = std::max(1, column - half); i <= std::min(map.columns() - 2, column + half); ++i) {
      if (visible.at<unsigned char>(ray, i - 1) == 0) continue;
      if (best < 0 || strength.at<float>(ray, i) > strength.at<float>(ray, best)) best = i;
    }
    if (best < 0 || strength.at<float>(ray, best) < kLeastLineStrength) continue;
    const double a = strength.at<float>(ray, best - 1), b = strength.at<float>(ray, best),
                 c = strength.at<float>(ray, best + 1), bend = a - 2 * b + c;
    if (a > b || c > b) continue;
    places.push_back({map.direction(ray), best + (bend < 0 ? std::clamp(0.5 * (a - c) / bend, -0.5, 0.5) : 0)});
  }
  return places;
}

/// Thickness t + a cos + b sin (columns), with Tukey's weights. A short arc does not determine a and
/// b: they are small unless it does.
struct ThicknessFit {
  bool valid = false;
  Eigen::Vector3d value{0, 0, 0};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double residual = 0;
  double at(double direction) const { return value.dot(Eigen::Vector3d(1, std::cos(direction), std::sin(direction))); }
};

ThicknessFit fitThickness(const std::vector<LinePlace>& places, double column, double tilt) {
  ThicknessFit fit;
  if (places.size() < 12) return fit;
  fit.value[0] = column;
  double scale = 3;
  for (int round = 0; round < 8; ++round) {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right(0, 0, 0);
    matrix(1, 1) = matrix(2, 2) = scale * scale / (tilt * tilt);
    std::vector<double> rest;
    for (const LinePlace& place : places) {
      const Eigen::Vector3d row(1, std::cos(place.direction), std::sin(place.direction));
      const double error = place.column - row.dot(fit.value), d = error / (RobustLoss::kTukey * scale);
      rest.push_back(std::abs(error));
      const double weight = std::abs(d) < 1 ? (1 - d * d) * (1 - d * d) : 0;
      matrix += weight * row * row.transpose();
      right += weight * place.column * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
    if (solver.info() != Eigen::Success || !(matrix(0, 0) > 6)) return fit;
    fit.value = solver.solve(right);
    fit.covariance = scale * scale * matrix.inverse();
    std::nth_element(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2), rest.end());
    fit.residual = 1.4826 * rest[rest.size() / 2];
    scale = std::max(0.3, fit.residual);
  }
  fit.valid = true;
  return fit;
}

/// The strongest column, and the strength of the next best one.
int bestColumn(const std::vector<double>& mean, const std::vector<double>& share, double& next) {
  int best = -1;
  const auto weight = [&](std::size_t i) { return share[i] < kLeastRayShare ? 0 : mean[i] * std::sqrt(share[i]); };
  for (std::size_t i = 0; i < mean.size(); ++i) {
    if (weight(i) > (best < 0 ? 0 : weight(static_cast<std::size_t>(best)))) best = static_cast<int>(i);
  }
  next = 0;
  for (std::size_t i = 0; best >= 0 && i < mean.size(); ++i) {
    if (std::abs(static_cast<int>(i) - best) * kRayStep > kNeighbour) next = std::max(next, weight(i));
  }
  if (best >= 0) next /= weight(static_cast<std::size_t>(best));
  return best;
}

}  // namespace

CellBorder findZonaInner(const Frame& frame, const CellBorder& outer, const CellBorder& ooplasm) {
  CellBorder border;
  border.finding = Finding::notFound("the zona's inner border is not seen beside the ooplasm's rim");
  const double radius = 0.5 * outer.ellipse.meanDiameter(), inner = 0.5 * ooplasm.ellipse.meanDiameter();
  const double low = inner - radius - 4, high = -kOuterMargin;
  if (high - low < 6) return border;
  const int columns = static_cast<int>((high - low) / kRayStep) + 1;
  const PolarMap map(frame, outer.ellipse, {low, low + (columns - 1) * kRayStep, columns, kZonaRays},
                     kRayBlur / kRayStep);
  cv::Mat visible;
  const cv::Mat strength = lineStrength(frame, map, ooplasm, visible);
  std::vector<double> mean, share;
  columnMeans(strength, visible, mean, share);
  double next = 0;
  const int column = bestColumn(mean, share, next);
  if (column < 0 || mean[column] < kLeastLineStrength) return border;
  const std::vector<LinePlace> places = placesOf(map, strength, visible, column, static_cast<int>(3 / kRayStep));
  const ThicknessFit fit = fitThickness(places, column, kZonaTilt * radius / kRayStep);
  if (!fit.valid) return border;
  const double change = low + kRayStep * fit.value[0];
  border.ellipse = outer.ellipse;
  border.ellipse.centre += kRayStep * cv::Point2d(fit.value[1], fit.value[2]);
  border.ellipse.semi_axes.array() += change;
  border.covariance.diagonal() << 2, 2, 4 * fit.covariance(0, 0) * kRayStep * kRayStep;
  border.covariance.topLeftCorner<2, 2>() =
      kRayStep * kRayStep * fit.covariance.bottomRightCorner<2, 2>() + outer.covariance.topLeftCorner<2, 2>();
  border.covariance(2, 2) += outer.covariance(2, 2);
  border.polarity = outer.polarity;
  border.residual = fit.residual * kRayStep;
  border.coverage = static_cast<double>(places.size()) / kZonaRays;
  border.strength = mean[column];
  border.consistency = std::min(1.0, static_cast<double>(places.size()) / std::max(1.0, share[column] * kZonaRays));
  for (const LinePlace& place : places) {
    const double r = outer.ellipse.radius(place.direction) + low + kRayStep * place.column;
    border.points.push_back(outer.ellipse.centre +
                            r * cv::Point2d(std::cos(place.direction), std::sin(place.direction)));
    border.inlier.push_back(std::abs(place.column - fit.at(place.direction)) < 3 / kRayStep);
  }
  const bool sure = share[column] > kSureShare && mean[column] > kSureStrength && next * kBestRatio < 1;
  border.finding =
      sure ? Finding::found() : Finding::uncertain("the zona's inner border is faint or seen on a short arc");
  return border;
}

}  // namespace microinjection
