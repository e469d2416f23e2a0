#include "cell/surrogate/surrogate_contact.h"

#include <algorithm>
#include <utility>

#include "cell/surrogate/range_border.h"

namespace microinjection {
namespace {

constexpr double kOnAxis = 0.035;  ///< rad, of the contact point: there the range is deeper
/// Overlap of the tip with the cell at rest, over the tip's displacement, at which a contact ends:
/// a sticking surface follows the tip a little beyond its rest position.
constexpr double kEnd = -0.05;
constexpr double kFading = 0.03;  ///< same, over which the energy falls to zero, so that the force ends continuously

/// 0 below 0, 1 above 1, smooth.
Jet smoothStep(const Jet& x) {
  const double q = x.value;
  if (q <= 0) return {};
  if (q < 1) return chain(x, q * q * (3 - 2 * q), 6 * q * (1 - q), 6 - 12 * q);
  Jet one;
  one.value = 1;
  return one;
}

}  // namespace

SurrogateContact::SurrogateContact(const Scene& scene, std::shared_ptr<const SurrogateData> cell)
    : scene_(scene), radius_(scene.radius()), cell_(std::move(cell)) {
  const Scene::Tip& tip = scene.needle.tip;
  if (tip.rounded()) shape_ = RoundedTip::make(tip.shape, tip.radius, tip.edge_radius);
  makeLocals(0);
}

void SurrogateContact::makeLocals(double angle) {
  const double prepared = std::min(angle, cell_->range.angle);
  cell_->energy.makeLocal(prepared, local_energy_);
  if (!cell_->field.empty()) cell_->field.makeLocal(prepared, local_field_);
}

void SurrogateContact::reset() {
  contact_frame_.reset();
  energy_ = 0;
}

void SurrogateContact::continueFrom(const SurrogateContact& other) {
  radius_ = other.radius_;
  contact_frame_ = other.contact_frame_;
  if (!contact_frame_) return;
  displacement_ = other.displacement_;
  makeLocals(contact_frame_->angle);
  const double energy =
      evaluate(overlap(contact_frame_->origin + contact_frame_->rotation * displacement_, radius_)).energy.value;
  correction_ = other.correction_;
  correction_.scale(other.energy_ > 0 ? energy / other.energy_ : 0);
}

Jet SurrogateContact::overlap(const Eigen::Vector3d& tip, double radius) const {
  if (shape_) {
    const Gap gap = shape_->gap(-tip);
    return {radius - gap.distance, gap.normal, -gap.curvature};
  }
  const Jet x = Jet::coordinate(0, tip.x()), y = Jet::coordinate(1, tip.y());
  Jet squared = -1.0 * (x * x + y * y);
  squared.value += radius * radius;
  constexpr double kRim = 0.05;  // over the radius, from the cell's silhouette, where the needle passes the cell
  if (!(squared.value > kRim * kRim * radius * radius)) {
    return {-radius, Eigen::Vector3d::UnitZ(), {}};
  }
  return sqrt(squared) - Jet::coordinate(2, tip.z());
}

SurrogateContact::Local SurrogateContact::evaluate(const Jet& overlap) {
  const LimitedDisplacement limited(cell_->range, contact_frame_->angle < kOnAxis, displacement_);
  prepared_ = limited.inside && contact_frame_->angle <= 1.001 * cell_->range.angle;
  too_deep_ = limited.too_deep;
  const Eigen::Vector3d u = limited.value();
  Local local;
  local.energy = limited.compose(local_energy_.evaluate(u));
  local.force = -local.energy.gradient;
  local.stiffness = local.energy.hessian;
  if (!cell_->field.empty()) {
    Eigen::Matrix3d jacobian;
    const Eigen::Vector3d force = local_field_.evaluate(u, jacobian);
    const Jet turned = limited.compose({0, force, jacobian});  // transformed like a gradient
    local.force = turned.gradient;
    local.stiffness = -0.5 * (turned.hessian + turned.hessian.transpose());
  }
  const double length = displacement_.norm();
  if (overlap.value >= (kEnd + kFading) * length) return local;
  const Eigen::Matrix3d& turn = contact_frame_->rotation;
  const Jet in_frame{overlap.value, turn.transpose() * overlap.gradient, turn.transpose() * overlap.hessian * turn};
  Jet squared;
  for (int k = 0; k < 3; ++k) {
    const Jet x = Jet::coordinate(k, displacement_[k]);
    squared = squared + x * x;
  }
  Jet left = in_frame * inverse(sqrt(squared));
  left.value -= kEnd;
  const Jet fade = smoothStep((1 / kFading) * left);
  local.energy = local.energy * fade;
  local.force *= fade.value;
  local.stiffness *= fade.value;
  return local;
}

SurrogateContact::Result SurrogateContact::step(const Eigen::Vector3d& tip) {
  Result result;
  if (!contact_frame_ && overlap(tip, std::max(radius_, scene_.radius())).value < 0) radius_ = scene_.radius();
  const Jet overlap = this->overlap(tip, radius_);
  if (contact_frame_) displacement_ = contact_frame_->rotation.transpose() * (tip - contact_frame_->origin);
  if (overlap.value < (contact_frame_ ? kEnd * displacement_.norm() : 0)) reset();
  if (!contact_frame_) {
    if (overlap.value < 0) return result;
    contact_frame_ = ContactFrame::at(radius_, shape_, tip.head<2>());
    if (!contact_frame_) return result;
    makeLocals(contact_frame_->angle);
    correction_.reset();
    displacement_ = contact_frame_->rotation.transpose() * (tip - contact_frame_->origin);
  }
  const Local local = evaluate(overlap);
  energy_ = local.energy.value;
  Eigen::Vector3d force = -local.energy.gradient;
  if (!cell_->field.empty()) {
    force *= 1 - PassiveCorrection::kReserve;
    force += correction_.step(displacement_, local.force - force, local.energy.value);
  }
  result.prepared = prepared_;
  result.too_deep = too_deep_;
  result.force = contact_frame_->rotation * force;
  result.stiffness = contact_frame_->rotation * local.stiffness * contact_frame_->rotation.transpose();
  return result;
}

SurrogateContact::Shape SurrogateContact::shape() const {
  Shape free;
  free.cell = cell_.get();
  if (!contact_frame_) return free;
  return {cell_.get(), std::min(contact_frame_->angle, cell_->range.angle), contact_frame_->rotation,
          LimitedDisplacement(cell_->range, contact_frame_->angle < kOnAxis, displacement_).value()};
}

void SurrogateContact::surface(const SurrogateData& cell, const Shape& shape, Eigen::Matrix3Xd& at_rest,
                               Eigen::Matrix3Xd& displaced) {
  Eigen::VectorXd rest, moved;
  cell.surface.evaluate(shape.angle, shape.displacement, rest, moved);
  at_rest = shape.rotation * Eigen::Map<const Eigen::Matrix3Xd>(rest.data(), 3, rest.size() / 3);
  displaced = shape.rotation * Eigen::Map<const Eigen::Matrix3Xd>(moved.data(), 3, moved.size() / 3);
}

}  // namespace microinjection
