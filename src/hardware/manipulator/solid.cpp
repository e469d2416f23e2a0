#include "hardware/manipulator/solid.h"

namespace microinjection {
namespace {

constexpr double kAccuracy = 1e-10;  // m

/// Vector from the nearest point of the solid to a point (m), both in the solid's frame.
Eigen::Vector3d outOf(const Solid& solid, const Eigen::Vector3d& point) {
  const Eigen::Vector3d& half = solid.half;
  Eigen::Vector3d out = point;
  if (solid.shape == Solid::Shape::kBox) return point - point.cwiseMax(-half).cwiseMin(half);
  if (solid.shape == Solid::Shape::kSphere) return point * std::max(0.0, 1 - half.x() / std::max(point.norm(), 1e-300));
  const double across = point.head<2>().norm();
  out.head<2>() *= std::max(0.0, 1 - half.x() / std::max(across, 1e-300));
  out.z() -= std::clamp(point.z(), -half.z(), half.z());
  return out;
}

/// Smallest distance between a capsule's segment and a solid, and its gradient.
Solid::Nearest nearestOfSegment(const Capsule& capsule, const Eigen::Vector3d& offset, const Solid& solid,
                                double enough) {
  const Eigen::Vector3d start = capsule.start + offset;
  const Eigen::Vector3d along = capsule.end - capsule.start;
  Solid::Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  const auto at = [&](double x) {
    const Solid::Nearest here = solid.nearest(start + x * along);
    if (here.distance < best.distance) best = here;
    return ValueSlope{here.distance, here.away.dot(along)};
  };
  best.distance = convexMinimum(at, kAccuracy, enough);
  return best;
}

}  // namespace

Solid::Nearest Solid::nearest(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d out = outOf(*this, pose.linear().transpose() * (point - pose.translation()));
  Nearest result;
  result.distance = out.norm();
  if (result.distance > 0) result.away = pose.linear() * (out / result.distance);
  return result;
}

double distance(const Capsule& capsule, const Eigen::Vector3d& offset, const Solid& solid, double enough) {
  return nearestOfSegment(capsule, offset, solid, enough + capsule.radius).distance - capsule.radius;
}

double distanceAlongPath(const Capsule& capsule, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         const Solid& solid, double enough) {
  const Eigen::Vector3d displacement = to - from;
  const double at_start = distance(capsule, from, solid, enough + displacement.norm());
  if (at_start > enough + displacement.norm())
    return at_start - displacement.norm();  // the path is too short to come within `enough`
  const auto at = [&](double x) {
    const Solid::Nearest here =
        nearestOfSegment(capsule, from + x * displacement, solid, std::numeric_limits<double>::infinity());
    return ValueSlope{here.distance - capsule.radius, here.away.dot(displacement)};
  };
  return convexMinimum(at, kAccuracy, enough);
}

}  // namespace microinjection
