#pragma once

#include <ros/time.h>

#include <chrono>

namespace microinjection {

/// s. In simulated time that of the session, where nodes publish as often as time goes on; else of a
/// clock that does not jump.
inline double sessionNow() {
  if (ros::Time::isSimTime()) return ros::Time::now().toSec();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Silence (s) after which the controller counts as gone: it publishes ten times a second.
constexpr double kControllerSilence = 1;

}  // namespace microinjection
