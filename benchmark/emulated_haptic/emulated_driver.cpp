#include "benchmark/emulated_haptic/emulated_driver.h"

#include <algorithm>

#include "nodes/runtime/stamps.h"

namespace microinjection {

std::vector<std::string> emulatedDrivers() {
  return {"crtk", "omni", "geomagic", "force_dimension", "dvrk", "dvrk_2_0", "falcon", "joy", "spacenav"};
}

std::unique_ptr<EmulatedDriver> makeEmulatedDriver(const std::string& kind, Cycle& cycle,
                                                   const EmulatedDriver::Handler& handler) {
  if (kind == "omni" || kind == "geomagic") return makeEmulatedTouch(kind, cycle, handler);
  if (kind == "joy" || kind == "spacenav") return makeEmulatedStick(kind, cycle);
  return makeEmulatedCrtk(kind, cycle, handler);
}

bool EmulatedRate::due(const ros::Time& now) {
  constexpr double kEarly = 5e-4;  // s: a step that is early by less counts as due
  if (next_.isZero()) next_ = now;
  if (secondsBetween(now, next_) > kEarly) return false;
  // After a stall it does not catch up.
  next_ = std::max(next_ + ros::Duration(period_), now);
  return true;
}

sensor_msgs::Joy toJoy(const ros::Time& now, bool first, bool second) {
  sensor_msgs::Joy joy;
  joy.header.stamp = now;
  joy.buttons = {first ? 1 : 0, second ? 1 : 0};
  return joy;
}

}  // namespace microinjection
