#include "cell/contact/rounded_tip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

/// Unit vectors at a point: away from the axis, around it, and along it.
struct Cylindrical {
  explicit Cylindrical(const Eigen::Vector3d& point) : rho(std::hypot(point.x(), point.y())) {
    if (rho > 0) outward = Eigen::Vector3d(point.x() / rho, point.y() / rho, 0);
    around = Eigen::Vector3d(-outward.y(), outward.x(), 0);
  }
  double rho;                                          ///< m, from the axis
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();  ///< arbitrary on the axis
  Eigen::Vector3d around;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

Gap flatGap(const Eigen::Vector3d& point) {
  Gap gap;
  gap.distance = -point.z();
  gap.normal = -Eigen::Vector3d::UnitZ();
  return gap;
}

Gap shaftGap(const Cylindrical& at, double radius, double smallest) {
  Gap gap;
  gap.distance = at.rho - radius;
  gap.normal = at.outward;
  gap.curvature = at.around * at.around.transpose() / std::max(at.rho, smallest);
  return gap;
}

/// @pre beyond >= 0 and below >= 0: distances of the point from the core's corner, away from the
/// axis and down, m.
Gap edgeGap(const Cylindrical& at, double beyond, double below, double edge_radius, double smallest) {
  const double reach = std::hypot(beyond, below);
  const double sine = reach > 0 ? beyond / reach : 0, cosine = reach > 0 ? below / reach : 1;
  Gap gap;
  gap.distance = reach - edge_radius;
  gap.normal = sine * at.outward - cosine * at.up;
  const Eigen::Vector3d along = cosine * at.outward + sine * at.up;
  // Curvature around the axis: sine / rho. For a core without width it is 1 / reach, also on the
  // axis.
  const double hoop = beyond == at.rho ? 1 / std::max(reach, smallest) : sine / at.rho;
  gap.curvature = along * along.transpose() / std::max(reach, smallest) + hoop * at.around * at.around.transpose();
  return gap;
}

}  // namespace

RoundedTip::RoundedTip(double radius, double edge_radius)
    : core_radius_(radius - edge_radius), edge_radius_(edge_radius) {
  std::vector<std::string> errors;
  const auto require = [&](bool good, const char* key, double value, const std::string& allowed) {
    std::ostringstream message;
    message << "rounded tip: " << key << " = " << value << " m: must be " << allowed;
    if (!good) errors.push_back(message.str());
  };
  require(std::isfinite(radius) && radius > 0, "radius", radius, "in (0, inf) m");
  require(edge_radius > 0 && edge_radius <= radius, "edge_radius", edge_radius, "above 0 and at most the radius");
  if (!errors.empty()) throw ConfigError(errors);
}

RoundedTip RoundedTip::make(const std::string& shape, double radius, double edge_radius) {
  if (shape == "hemisphere") return RoundedTip(radius, radius);
  if (shape == "rounded_flat") return RoundedTip(radius, edge_radius);
  throw ConfigError("rounded tip: shape = " + shape + ": must be one of: hemisphere, rounded_flat");
}

double RoundedTip::distance(const Eigen::Vector3d& point) const {
  const double beyond = std::hypot(point.x(), point.y()) - core_radius_, below = edge_radius_ - point.z();
  const double outside = std::hypot(std::max(beyond, 0.0), std::max(below, 0.0));
  return outside + std::min(0.0, std::max(beyond, below)) - edge_radius_;
}

Gap RoundedTip::gap(const Eigen::Vector3d& point) const {
  const double smallest = 1e-9 * radius();
  const Cylindrical at(point);
  const double beyond = at.rho - core_radius_, below = edge_radius_ - point.z();
  if (beyond >= 0 && below >= 0) return edgeGap(at, beyond, below, edge_radius_, smallest);
  return beyond > below ? shaftGap(at, radius(), smallest) : flatGap(point);
}

double RoundedTip::touchHeight(double cell_radius, const Eigen::Vector2d& offset) const {
  if (offset.norm() <= core_radius_) return cell_radius;
  if (offset.norm() >= cell_radius + radius()) return std::numeric_limits<double>::quiet_NaN();
  const double aside = offset.norm() - core_radius_, reach = cell_radius + edge_radius_;
  return std::sqrt(reach * reach - aside * aside) - edge_radius_;
}

Eigen::Vector3d RoundedTip::touchPoint(double cell_radius, const Eigen::Vector2d& offset) const {
  Eigen::Vector3d centre(0, 0, touchHeight(cell_radius, offset) + edge_radius_);  // of the ball that touches
  if (offset.norm() > core_radius_) centre.head<2>() = offset * (1 - core_radius_ / offset.norm());
  return cell_radius * (centre / (cell_radius + edge_radius_));
}

}  // namespace microinjection
