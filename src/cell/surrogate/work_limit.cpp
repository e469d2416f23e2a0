#include "cell/surrogate/work_limit.h"

#include <algorithm>

namespace microinjection {

Eigen::Vector3d WorkLimit::step(const Eigen::Vector3d& force, const Eigen::Vector3d& tip, double energy) {
  constexpr double kStiffer = 4;   // factor up to which a changed cell is felt in full
  constexpr double kLeast = 0.01;  // from no force at all, W would never grow again
  const Eigen::Vector3d move = started_ ? Eigen::Vector3d(tip - tip_) : Eigen::Vector3d::Zero();
  const double before = work_ - 0.5 * force_.dot(move), cost = 0.5 * force.dot(move);
  double scale = 1;
  // The force acts over a half of this move and a half of the next one, which is taken to be as long. With W and E
  // after both: scale E = 4 (before - 2 scale cost).
  const double share = energy + 2 * kStiffer * cost;
  if (active_ && share > 0) scale = std::clamp(kStiffer * before / share, kLeast, 1.0);
  if (active_ && 2 * scale * cost > before) scale = std::max(0.0, 0.5 * before / cost);
  work_ = before - scale * cost;
  force_ = scale * force;
  tip_ = tip;
  started_ = true;
  return force_;
}

}  // namespace microinjection
