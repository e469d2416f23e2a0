#include "cell/model/contact_frame.h"

#include <Eigen/Geometry>
#include <cmath>

namespace microinjection {

std::optional<ContactFrame> ContactFrame::at(const Scene& scene, const Eigen::Vector2d& offset) {
  const Scene::Tip& shape = scene.needle.tip;
  std::optional<RoundedTip> tip;
  if (shape.rounded()) tip = RoundedTip::make(shape.shape, shape.radius, shape.edge_radius);
  return at(scene.radius(), tip, offset);
}

std::optional<ContactFrame> ContactFrame::at(double radius, const std::optional<RoundedTip>& tip,
                                             const Eigen::Vector2d& offset) {
  const double distance = offset.norm();
  ContactFrame place;
  Eigen::Vector3d touched;
  if (tip) {
    if (!(distance < radius + tip->radius())) return std::nullopt;
    place.origin << offset, tip->touchHeight(radius, offset);
    touched = tip->touchPoint(radius, offset);
  } else {
    if (!(distance < radius)) return std::nullopt;
    place.origin << offset, std::sqrt(radius * radius - distance * distance);
    touched = place.origin;
  }
  place.angle = std::atan2(touched.head<2>().norm(), touched.z());
  if (distance > 0) {
    place.rotation = Eigen::AngleAxisd(std::atan2(offset.y(), offset.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return place;
}

Eigen::Vector2d ContactFrame::offsetFor(const Scene& scene, double angle) {
  const Scene::Tip& tip = scene.needle.tip;
  if (!tip.rounded()) return {scene.radius() * std::sin(angle), 0};
  const double core = tip.radius - tip.edgeRadius();  // a flat end meets the cell with its edge
  return {angle > 0 ? core + (scene.radius() + tip.edgeRadius()) * std::sin(angle) : 0, 0};
}

}  // namespace microinjection
