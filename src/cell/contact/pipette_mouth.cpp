#include "cell/contact/pipette_mouth.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace microinjection {
namespace {

/// In the plane of the axis and a point: offset (r, z) of the point from the nearest point of the core, or in the core,
/// to its nearest face.
struct OffCore {
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m; outside of the core
  double depth = 0;                                  ///< m, below the core's nearest face; 0 outside
  Eigen::Vector2d out = Eigen::Vector2d::Zero();     ///< unit, of that face
};

OffCore offCore(double r, double z, double inner, double outer, double lowest) {
  OffCore result;
  result.offset = {r < inner ? r - inner : std::max(r - outer, 0.0), std::min(z - lowest, 0.0)};
  if (!result.offset.isZero(0)) return result;
  const double to_bore = r - inner, to_outside = outer - r, to_end = z - lowest;
  result.depth = std::min({to_bore, to_outside, to_end});
  result.out = result.depth == to_end    ? Eigen::Vector2d(0, -1)
               : result.depth == to_bore ? Eigen::Vector2d(-1, 0)
                                         : Eigen::Vector2d(1, 0);
  return result;
}

}  // namespace

PipetteMouth::PipetteMouth(double inner_radius, double outer_radius, double edge_radius, double side)
    : inner_radius_(inner_radius), outer_radius_(outer_radius), edge_radius_(edge_radius), side_(side) {
  const double wall = outer_radius - inner_radius;
  const bool good = inner_radius > 0 && wall > 0 && std::isfinite(outer_radius) && edge_radius > 0 &&
                    edge_radius <= (1 + 1e-9) * wall / 2 && std::abs(side) == 1;
  if (good) return;
  std::ostringstream message;
  message << "pipette mouth: radii " << inner_radius << ", " << outer_radius << " m and edge " << edge_radius
          << " m: the outer radius must be above the inner one, and the edge above 0 and at most half of the wall";
  throw std::invalid_argument(message.str());
}

double PipetteMouth::distance(const Eigen::Vector3d& point) const {
  const double r = std::hypot(point.x(), point.y());
  const OffCore at =
      offCore(r, side_ * point.z(), crestRadius(), std::max(outer_radius_ - edge_radius_, crestRadius()), edge_radius_);
  return at.offset.norm() - at.depth - edge_radius_;
}

Gap PipetteMouth::gap(const Eigen::Vector3d& point) const {
  const double smallest = 1e-9 * inner_radius_, r = std::hypot(point.x(), point.y());
  const OffCore at =
      offCore(r, side_ * point.z(), crestRadius(), std::max(outer_radius_ - edge_radius_, crestRadius()), edge_radius_);
  const double reach = at.offset.norm();
  const Eigen::Vector2d normal = reach > 0 ? Eigen::Vector2d(at.offset / reach) : at.out;
  const Eigen::Vector3d outward = r > 0 ? Eigen::Vector3d(point.x() / r, point.y() / r, 0) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d around(-outward.y(), outward.x(), 0), up = side_ * Eigen::Vector3d::UnitZ();
  Gap gap;
  gap.distance = reach - at.depth - edge_radius_;
  gap.normal = normal[0] * outward + normal[1] * up;
  // The lip is round in the plane of the axis where its nearest point is the core's corner, and everywhere around it.
  const bool corner = at.offset[0] != 0 && at.offset[1] != 0;
  const Eigen::Vector3d along = -normal[1] * outward + normal[0] * up;
  if (corner) gap.curvature = along * along.transpose() / std::max(reach, smallest);
  gap.curvature += normal[0] / std::max(r, smallest) * around * around.transpose();
  return gap;
}

double PipetteMouth::touchRadius(double cell_radius) const {
  return crestRadius() * cell_radius / (cell_radius + edge_radius_);
}

double PipetteMouth::touchDistance(double cell_radius) const {
  const double reach = cell_radius + edge_radius_;
  return std::sqrt(std::max(reach * reach - crestRadius() * crestRadius(), 0.0)) - edge_radius_;
}

}  // namespace microinjection
