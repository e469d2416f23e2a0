#include "operation/teleoperation/velocity_estimate.h"

#include <algorithm>

namespace microinjection {

bool VelocityEstimate::straight(int length) const {
  const Sample &end = back(0), &start = back(length);
  const Eigen::Vector3d velocity = (end.position - start.position) / (end.time - start.time);
  for (int i = 1; i < length; ++i) {
    const Eigen::Vector3d on_line = end.position + (back(i).time - end.time) * velocity;
    if ((on_line - back(i).position).cwiseAbs().maxCoeff() > resolution_) return false;
  }
  return true;
}

void VelocityEstimate::add(const Eigen::Vector3d& position, double dt) {
  const double time = count_ > 0 ? back(0).time + dt : 0;
  newest_ = (newest_ + 1) % (kLongest + 1);
  samples_[newest_] = {position, time};
  count_ = std::min(count_ + 1, kLongest + 1);
  if (count_ < 2) return;
  int length = 1;
  while (length + 1 < count_ && straight(length + 1)) ++length;
  value_ = (position - back(length).position) / (time - back(length).time);
}

}  // namespace microinjection
