#include "vision/frame/ellipse.h"

#include <Eigen/Dense>
#include <algorithm>

#include "base/median.h"
#include "vision/frame/robust_loss.h"

namespace microinjection {
namespace {

constexpr int kFitRounds = 12;
constexpr std::size_t kFewestPoints = 12;

/// Centre and the symmetric square root of the ellipse's matrix, x right and y down: |R (x - c)| =
/// 1. Unlike axes and angle it is smooth at the circle.
struct Shape {
  Eigen::Vector2d centre;
  Eigen::Matrix2d root;
};

Shape shapeOf(const Ellipse& ellipse) {
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(ellipse.angle).toRotationMatrix();
  return {{ellipse.centre.x, ellipse.centre.y},
          turn * ellipse.semi_axes.cwiseInverse().asDiagonal() * turn.transpose()};
}

Ellipse ellipseOf(const Shape& shape) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(shape.root);
  const Eigen::Vector2d major = solver.eigenvectors().col(0);
  return {{shape.centre.x(), shape.centre.y()}, solver.eigenvalues().cwiseInverse(), std::atan2(major.y(), major.x())};
}

using Parameters = Eigen::Matrix<double, 5, 1>;  // centre x, y; root xx, yy, xy

/// Distance (px, first order) of a point, and its derivatives.
double distanceOf(const Shape& shape, const cv::Point2d& point, Parameters& slope) {
  const Eigen::Vector2d d = Eigen::Vector2d(point.x, point.y) - shape.centre;
  const Eigen::Vector2d u = shape.root * d;
  const double length = std::max(u.norm(), 1e-9);
  const Eigen::Vector2d v = shape.root * u / length;  // gradient of |R d| with respect to d
  const double grade = std::max(v.norm(), 1e-9);
  slope << -v.x(), -v.y(), u.x() * d.x() / length, u.y() * d.y() / length, (u.x() * d.y() + u.y() * d.x()) / length;
  slope /= grade;
  return (length - 1) / grade;
}

double scaleOf(const std::vector<double>& residuals) {
  std::vector<double> sizes;
  sizes.reserve(residuals.size());
  for (const double residual : residuals) sizes.push_back(std::abs(residual));
  return std::max(1.4826 * upperMedian(std::move(sizes)), 0.02);
}

/// Number of neighbouring points that deviate together: of the residuals' correlation at lag 1.
double runOf(const std::vector<double>& residuals, const std::vector<bool>& inlier) {
  double product = 0, square = 0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const std::size_t next = (i + 1) % residuals.size();
    if (!inlier[i] || !inlier[next]) continue;
    product += residuals[i] * residuals[next];
    square += 0.5 * (residuals[i] * residuals[i] + residuals[next] * residuals[next]);
  }
  const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.95) : 0;
  return (1 + correlation) / (1 - correlation);
}

struct Normal {
  Eigen::Matrix<double, 5, 5> matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Parameters right = Parameters::Zero();
  std::vector<double> residuals;
};

Normal normalOf(const Shape& shape, const std::vector<cv::Point2d>& points, double scale) {
  Normal normal;
  for (const cv::Point2d& point : points) {
    Parameters slope;
    const double residual = distanceOf(shape, point, slope);
    normal.residuals.push_back(residual);
    const double relative = residual / (RobustLoss::kTukey * scale);
    if (std::abs(relative) >= 1) continue;
    const double weight = (1 - relative * relative) * (1 - relative * relative);
    normal.matrix += weight * slope * slope.transpose();
    normal.right -= weight * residual * slope;
  }
  return normal;
}

/// Columns: the free directions of the parameters. A circle keeps root xx = yy and xy = 0.
Eigen::MatrixXd directions(bool circle) {
  if (!circle) return Eigen::MatrixXd::Identity(5, 5);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(5, 3);
  columns(0, 0) = columns(1, 1) = columns(2, 2) = columns(3, 2) = 1;
  return columns;
}

void step(Shape& shape, const Parameters& change) {
  shape.centre += change.head<2>();
  shape.root(0, 0) += change[2];
  shape.root(1, 1) += change[3];
  shape.root(0, 1) += change[4];
  shape.root(1, 0) = shape.root(0, 1);
}

/// Mean diameter = 2 / sqrt(det R).
Eigen::Matrix<double, 3, 5> outputSlope(const Shape& shape) {
  Eigen::Matrix<double, 3, 5> slope = Eigen::Matrix<double, 3, 5>::Zero();
  slope(0, 0) = slope(1, 1) = 1;
  const double factor = -std::pow(shape.root.determinant(), -1.5);
  slope.row(2) << 0, 0, factor * shape.root(1, 1), factor * shape.root(0, 0), -2 * factor * shape.root(0, 1);
  return slope;
}

}  // namespace

double Ellipse::meanDiameter() const { return 2 * std::sqrt(semi_axes[0] * semi_axes[1]); }

cv::Point2d Ellipse::at(double t) const {
  const double x = semi_axes[0] * std::cos(t), y = semi_axes[1] * std::sin(t);
  return centre + cv::Point2d(x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle));
}

double Ellipse::radius(double direction) const {
  const double t = direction - angle;
  return 1 / std::hypot(std::cos(t) / semi_axes[0], std::sin(t) / semi_axes[1]);
}

std::optional<double> Ellipse::exit(const cv::Point2d& from, double direction) const {
  const Eigen::Matrix2d root = shapeOf(*this).root;
  const Eigen::Vector2d start = root * Eigen::Vector2d(from.x - centre.x, from.y - centre.y);
  const Eigen::Vector2d along = root * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  const double a = along.squaredNorm(), b = along.dot(start), square = b * b - a * (start.squaredNorm() - 1);
  if (!(square > 0)) return std::nullopt;
  return (std::sqrt(square) - b) / a;
}

double Ellipse::reach(const cv::Point2d& from, double direction) const {
  const Eigen::Vector2d start = shapeOf(*this).root * Eigen::Vector2d(from.x - centre.x, from.y - centre.y);
  return start.squaredNorm() < 1 ? exit(from, direction).value_or(0) : 0;
}

double Ellipse::distance(const cv::Point2d& point) const {
  Parameters slope;
  return distanceOf(shapeOf(*this), point, slope);
}

EllipseFit fitEllipse(const std::vector<cv::Point2d>& points, const Ellipse& start, double tolerance, bool circle) {
  EllipseFit fit;
  if (points.size() < kFewestPoints || !(start.semi_axes.minCoeff() > 0)) return fit;
  Shape shape = shapeOf(start);
  const Eigen::MatrixXd free = directions(circle);
  Normal normal = normalOf(shape, points, 1e9);
  double scale = scaleOf(normal.residuals);
  Eigen::MatrixXd reduced;
  for (int round = 0; round < kFitRounds; ++round) {
    scale = std::max(scaleOf(normal.residuals), 0.25 * tolerance / RobustLoss::kTukey);
    normal = normalOf(shape, points, scale);
    reduced = free.transpose() * normal.matrix * free;
    const Eigen::LDLT<Eigen::MatrixXd> solver(reduced);
    if (solver.info() != Eigen::Success || solver.rcond() < 1e-12) return fit;
    const Parameters change = free * solver.solve(free.transpose() * normal.right);
    step(shape, change);
    if (!(shape.root.determinant() > 0) || !(shape.root(0, 0) > 0)) return fit;
    if (change.head<2>().norm() < 1e-4 && change.tail<3>().norm() < 1e-6 * shape.root.norm()) break;
  }
  normal = normalOf(shape, points, scale);
  fit.ellipse = ellipseOf(shape);
  const double limit = std::max(tolerance, 3 * std::min(scaleOf(normal.residuals), tolerance));
  double square = 0;
  int count = 0;
  for (const double residual : normal.residuals) {
    fit.inlier.push_back(std::abs(residual) <= limit);
    if (!fit.inlier.back()) continue;
    square += residual * residual;
    ++count;
  }
  if (count < static_cast<int>(kFewestPoints)) return fit;
  fit.residual = std::sqrt(square / count);
  const Eigen::MatrixXd parameters = free * reduced.inverse() * free.transpose();
  const Eigen::Matrix<double, 3, 5> slope = outputSlope(shape);
  fit.covariance =
      square / std::max(count - 5, 1) * runOf(normal.residuals, fit.inlier) * (slope * parameters * slope.transpose());
  fit.valid = true;
  return fit;
}

}  // namespace microinjection
