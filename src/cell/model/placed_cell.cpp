#include "cell/model/placed_cell.h"

#include <algorithm>

namespace microinjection {

void PlacedCell::follow(const Eigen::Vector3d& offset) {
  for (int i = 0; i < 3; ++i) offset_[i] = offset[i];
}

/// m, of the cell's origin. A picture that is drawn in the midst of a step may have parts of two.
Eigen::Vector3d PlacedCell::place() const { return {offset_[0], offset_[1], offset_[2] + height_}; }

TipForce PlacedCell::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double time) {
  constexpr double kLongest = 0.01;  // s: after a pause the cell does not leap
  const double passed = time_ ? std::clamp(time - *time_, 0.0, kLongest) : 0;
  time_ = time;
  const double reach = kSpeed * passed;
  height_ = height_ + std::clamp(wanted_ - height_, -reach, reach);
  const Eigen::Vector3d shift = place();
  const TipForce force = cell_.step(tip - shift, axis, time);
  contact_ = cell_.contact();
  if (contact_) contact_->contact_point += shift;
  return force;
}

CellModel::DeformedSurface PlacedCell::deformedSurface() {
  DeformedSurface surface = cell_.deformedSurface();
  const Eigen::Vector3d shift = place();
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
