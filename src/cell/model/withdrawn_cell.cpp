#include "cell/model/withdrawn_cell.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kOnAxis = 0.1;  ///< tip radii beside the axis, up to which the loss is known

}  // namespace

TipForce WithdrawnCell::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  TipForce result = cell_->step(tip, axis, time);
  const std::optional<Contact>& inner = cell_->contact();
  contact_ = inner;
  if (!result.valid) return result;
  if (inner && !touch_) touch_ = Touch{inner->contact_point};
  if (!touch_) return result;
  const Eigen::Vector3d moved = tip - touch_->point;
  const double depth = -moved.dot(axis), beside = (moved + depth * axis).norm();
  const double reach = loss_.reach(touch_->turn);
  if (!inner && (reach == 0 || depth < -reach || beside > tip_radius_)) {
    touch_.reset();
    return result;
  }
  touch_->beside = beside;
  result.force -= loss(depth, result.force.dot(axis)) * axis;
  if (!inner) contact_ = Contact{touch_->point, moved, depth};
  return result;
}

double WithdrawnCell::loss(double depth, double force) {
  Touch& touch = *touch_;
  if (depth >= touch.turn) {
    touch.turn = depth;
    touch.force = std::max(force, 0.0);
    touch.slip = 1;
  } else if (touch.turn > 0) {
    touch.slip = std::clamp(touch.slip - (depth - touch.depth) / (kReversal * touch.turn), 0.0, 1.0);
  }
  touch.depth = depth;
  if (!(touch.turn > 0)) return 0;
  return touch.slip * loss_.share(depth, touch.turn) * touch.force;
}

std::optional<double> WithdrawnCell::forceError() const {
  const std::optional<double> in = cell_->forceError();
  if (!in || !touch_ || touch_->depth >= touch_->turn) return in;
  const double off_pole = touch_->point.head<2>().norm();
  if (std::max(touch_->beside, off_pole) > kOnAxis * tip_radius_) return std::nullopt;
  return std::hypot(*in, loss_.error() * touch_->slip * touch_->force);
}

void WithdrawnCell::release() {
  cell_->release();
  touch_.reset();
  contact_.reset();
}

}  // namespace microinjection
