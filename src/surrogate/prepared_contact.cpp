#include "surrogate/prepared_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microinjection {
namespace {

/// The nearest place in the range, m: depth and lateral motion are cut each.
Eigen::Vector3d clamp(const PreparationRange& range, const Eigen::Vector3d& u) {
  Eigen::Vector3d result = u;
  const double lateral = u.head<2>().norm();
  if (lateral > range.lateral) result.head<2>() *= range.lateral / lateral;
  result.z() = std::max(u.z(), -range.depth);
  return result;
}

}  // namespace

PreparedContact::PreparedContact(const Scene& scene, std::shared_ptr<const PreparedCell> cell)
    : scene_(scene), cell_(std::move(cell)) {
  const Scene::Tip& tip = scene.needle.tip;
  if (tip.rounded()) shape_ = RoundedTip::make(tip.shape, tip.radius, tip.edge_radius);
  cell_->energy.makeLocal(0, local_);
}

bool PreparedContact::overlaps(const Eigen::Vector3d& tip) const {
  if (shape_) return shape_->distance(-tip) < scene_.radius();
  const double height =
      tip.z() - std::sqrt(std::max(0.0, scene_.radius() * scene_.radius() - tip.head<2>().squaredNorm()));
  return height < 0 && tip.z() > 0;
}

PreparedContact::Answer PreparedContact::step(const Eigen::Vector3d& tip) {
  Answer answer;
  energy_ = 0;
  if (!overlaps(tip)) {
    place_.reset();
    return answer;
  }
  if (!place_) {
    place_ = ContactPlace::at(scene_, tip.head<2>());
    if (!place_) return answer;
    cell_->energy.makeLocal(std::min(place_->angle, cell_->range.angle), local_);
  }
  displacement_ = place_->rotation.transpose() * (tip - place_->origin);
  const Eigen::Vector3d known = clamp(cell_->range, displacement_);
  const Jet energy = local_.evaluate(known);
  energy_ = energy.value;
  answer.prepared = known == displacement_ && place_->angle <= 1.001 * cell_->range.angle;
  answer.force = -(place_->rotation * energy.gradient);
  answer.stiffness = place_->rotation * energy.hessian * place_->rotation.transpose();
  return answer;
}

void PreparedContact::surface(Eigen::Matrix3Xd& at_rest, Eigen::Matrix3Xd& displaced) const {
  Eigen::VectorXd rest, moved;
  const ContactPlace place = place_.value_or(ContactPlace());
  const Eigen::Vector3d u = place_ ? clamp(cell_->range, displacement_) : Eigen::Vector3d::Zero();
  cell_->surface.evaluate(std::min(place.angle, cell_->range.angle), u, rest, moved);
  at_rest = place.rotation * rest.reshaped(3, rest.size() / 3);
  displaced = place.rotation * moved.reshaped(3, moved.size() / 3);
}

}  // namespace microinjection
