#include "cell/model/placed_cell.h"

#include <algorithm>

namespace microinjection {

TipForce PlacedCell::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  constexpr double kLongest = 0.01;  // s: after a pause the cell does not leap
  const double passed = time_ ? std::clamp(time - *time_, 0.0, kLongest) : 0;
  time_ = time;
  const double reach = kSpeed * passed;
  height_ = height_ + std::clamp(wanted_ - height_, -reach, reach);
  const Eigen::Vector3d shift(0, 0, height_);
  const TipForce force = cell_.step(tip - shift, axis, time);
  contact_ = cell_.contact();
  if (contact_) contact_->contact_point += shift;
  return force;
}

CellModel::DeformedSurface PlacedCell::deformedSurface() {
  DeformedSurface surface = cell_.deformedSurface();
  const Eigen::Vector3d shift(0, 0, height_);
  if (shift.isZero(0)) return surface;
  for (Eigen::Vector3d& vertex : surface.vertices) vertex += shift;
  for (Eigen::Vector3d& vertex : surface.at_rest) vertex += shift;
  for (Eigen::Vector3d& vertex : surface.border_vertices) vertex += shift;
  for (Eigen::Vector3d& hole : surface.holes) hole += shift;
  for (Member& member : surface.members) {
    member.from += shift;
    member.to += shift;
  }
  return surface;
}

}  // namespace microinjection
