#include "hardware/sensor/overload_latch.h"

#include <sstream>

#include "base/plausible.h"

namespace microinjection {

void OverloadLatch::check(const Eigen::Vector2d& load) {
  latched_ = latched_ || (load.cwiseAbs().array() > limit_.array()).any();
  if (latched_) largest_ = largest_.cwiseMax(load.cwiseAbs());
}

std::string OverloadLatch::text() const {
  if (!latched_) return "";
  const Eigen::Vector2d times = largest_.cwiseQuotient(limit_);
  const int axis = times[0] >= times[1] ? 0 : 1;
  std::ostringstream text;
  text << largest_[axis] << " N " << (axis == 0 ? "along" : "across") << " the pipette, " << times[axis] << " times "
       << (axis == 0 ? "axial" : "lateral") << "_overload = " << limit_[axis] << " N";
  const std::string slip = unitSlip(times[axis], "N");
  if (!slip.empty()) text << " (" << slip << ")";
  return text.str();
}

}  // namespace microinjection
