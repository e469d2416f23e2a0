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
  ContactFrame frame;
  Eigen::Vector3d contact_point;
  if (tip) {
    if (!(distance < radius + tip->radius())) return std::nullopt;
    frame.origin << offset, tip->touchHeight(radius, offset);
    contact_point = tip->touchPoint(radius, offset);
  } else {
    if (!(distance < radius)) return std::nullopt;
    frame.origin << offset, std::sqrt(radius * radius - distance * distance);
    contact_point = frame.origin;
  }
  frame.angle = std::atan2(contact_point.head<2>().norm(), contact_point.z());
  if (distance > 0) {
    frame.rotation = Eigen::AngleAxisd(std::atan2(offset.y(), offset.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
  return frame;
}

Eigen::Vector2d ContactFrame::offsetFor(const Scene& scene, double angle) {
  const Scene::Tip& tip = scene.needle.tip;
  if (!tip.rounded()) return {scene.radius() * std::sin(angle), 0};
  const double core = tip.radius - tip.edgeRadius();  // the edge of a flat end touches first
  return {angle > 0 ? core + (scene.radius() + tip.edgeRadius()) * std::sin(angle) : 0, 0};
}

}  // namespace microinjection
