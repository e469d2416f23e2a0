#include "cell/mesh/circle_on_sphere.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kCorners = 80;  // sagitta of the polygon: 1 - cos(pi / 80) = 0.8e-3 of the radius

double distanceToSegment(const Eigen::Vector3d& point, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d along = to - from;
  const double at = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - at * along).norm();
}

}  // namespace

Eigen::Vector3d pointOnSphere(const Eigen::Vector2d& xy, double side, double radius) {
  return {xy.x(), xy.y(), side * std::sqrt(std::max(0.0, radius * radius - xy.squaredNorm()))};
}

CircleOnSphere::CircleOnSphere(const Eigen::Vector2d& centre, double radius, double side, double sphere_radius)
    : centre_(centre), radius_(radius), side_(side), sphere_radius_(sphere_radius), corners_(kCorners, 3) {
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * M_PI * i / kCorners;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    corners_.row(i) = pointOnSphere(centre_ + radius_ * direction, side_, sphere_radius_).transpose();
  }
}

Eigen::Vector3d CircleOnSphere::project(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d direction = (point.head<2>() - centre_).normalized();
  return pointOnSphere(centre_ + radius_ * direction, side_, sphere_radius_);
}

double CircleOnSphere::distance(const Eigen::Vector3d& point) const {
  int nearest = 0;
  ((corners_.col(0).array() - point.x()).square() + (corners_.col(1).array() - point.y()).square() +
   (corners_.col(2).array() - point.z()).square())
      .minCoeff(&nearest);
  const Eigen::Vector3d corner = corners_.row(nearest).transpose();
  const Eigen::Vector3d before = corners_.row((nearest + kCorners - 1) % kCorners).transpose();
  const Eigen::Vector3d after = corners_.row((nearest + 1) % kCorners).transpose();
  return std::min(distanceToSegment(point, before, corner), distanceToSegment(point, corner, after));
}

}  // namespace microinjection
