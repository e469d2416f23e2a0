#pragma once

#include <ros/duration.h>
#include <ros/time.h>

#include <cmath>
#include <cstdint>

namespace microinjection {

/// A message whose stamp is farther ahead of this node's time (s) is refused. NTP keeps clocks
/// within milliseconds.
constexpr double kLargestLead = 1;

/// Seconds from one time to another, of ros::Time, ros::WallTime or ros::SteadyTime. The difference
/// of two ros::Time throws beyond 2^31 s, so one wrong stamp would end a node. This function never
/// throws.
template <typename Time>
double secondsBetween(const Time& from, const Time& to) {
  return 1e-9 * static_cast<double>(static_cast<std::int64_t>(to.toNSec()) - static_cast<std::int64_t>(from.toNSec()));
}

/// Whether `period` (s) has passed since `last`, or the clock was set back meanwhile: what is repeated goes on then,
/// and does not wait until the clock has caught up.
template <typename Time>
bool isDue(const Time& last, const Time& now, double period) {
  return now < last || secondsBetween(last, now) >= period;
}

/// A duration of whole nanoseconds.
inline ros::Duration durationOf(double seconds) {
  ros::Duration duration;
  return duration.fromNSec(std::llround(1e9 * seconds));
}

/// Whether a stamp is implausibly far in the future.
inline bool isAhead(const ros::Time& stamp, const ros::Time& now) { return secondsBetween(now, stamp) > kLargestLead; }

}  // namespace microinjection
