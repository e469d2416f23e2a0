#include "benchmark/emulated_haptic/round_trip_meter.h"

#include <cmath>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kWaitingTime = 0.5;  // s, until every message of a round trip has arrived
const ros::Duration kMemory(2);
constexpr double kSame = 1e-9;  // relative rounding error of a force by units and axes

template <typename Value>
void discardBefore(std::map<ros::Time, Value>& entries, const ros::Time& time) {
  entries.erase(entries.begin(), entries.lower_bound(time));
}

}  // namespace

RoundTripMeter::RoundTripMeter(Bus& bus) {
  using Trace = sensor_msgs::TimeReference;
  using geometry_msgs::WrenchStamped;
  setpoints_ = subscribeGuarded<Trace>(
      bus, "needle/setpoint_trace", 100,
      [this](const Trace& trace, const std::string&) { hand_of_needle_[trace.header.stamp] = trace.time_ref; });
  traces_ = subscribeGuarded<Trace>(bus, "haptic/force_trace", 100, [this](const Trace& trace, const std::string&) {
    needle_of_force_[trace.header.stamp] = trace.time_ref;
  });
  forces_ = subscribeGuarded<WrenchStamped>(bus, "haptic/servo_cf", 100,
                                            [this](const WrenchStamped& message, const std::string&) {
                                              rendered_[message.header.stamp] = toVector(message.wrench.force);
                                            });
}

void RoundTripMeter::addForce(const Eigen::Vector3d& force, const ros::Time& received) { received_[received] = force; }

void RoundTripMeter::step(const ros::Time& now) {
  while (!needle_of_force_.empty() && secondsBetween(needle_of_force_.begin()->first, now) > kWaitingTime) {
    count(needle_of_force_.begin()->first, needle_of_force_.begin()->second);
    needle_of_force_.erase(needle_of_force_.begin());
  }
  if (now.toSec() < kMemory.toSec()) return;
  discardBefore(hand_of_needle_, now - kMemory);
  discardBefore(rendered_, now - kMemory);
  discardBefore(received_, now - kMemory);
}

void RoundTripMeter::count(const ros::Time& rendered, const ros::Time& needle) {
  const auto hand = hand_of_needle_.find(needle);
  const auto force = rendered_.find(rendered);
  if (hand == hand_of_needle_.end() || hand->second <= last_hand_) return;  // the needle moved by itself, or counted
  if (force == rendered_.end() || force->second.isZero(0)) return;
  for (auto arrival = received_.lower_bound(rendered); arrival != received_.end(); ++arrival) {
    // Compares magnitudes: the device may have other axes than the bridge.
    if (std::abs(arrival->second.norm() - force->second.norm()) > kSame * force->second.norm()) continue;
    at_bridge_.add(secondsBetween(hand->second, rendered));
    at_device_.add(secondsBetween(hand->second, arrival->first));
    last_hand_ = hand->second;
    return;
  }
}

}  // namespace microinjection
