#include "nodes/runtime/latency_meter.h"

#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr std::size_t kCapacity = 200;  // traced needle poses, two seconds of them

}  // namespace

LatencyMeter::LatencyMeter(Bus& bus)
    : setpoints_(subscribe(bus, "needle/setpoint_trace", &LatencyMeter::onSetpoint)),
      forces_(subscribe(bus, "haptic/force_trace", &LatencyMeter::onForce)) {}

Subscription LatencyMeter::subscribe(Bus& bus, const std::string& topic, void (LatencyMeter::*handler)(const Trace&)) {
  return subscribeGuarded<Trace>(bus, topic, 100, [this, &bus, topic, handler](const Trace& trace, const std::string&) {
    if (isAhead(trace.time_ref, bus.now())) return bus.refusals().add(topic, "its time_ref is ahead");
    (this->*handler)(trace);
  });
}

void LatencyMeter::onSetpoint(const Trace& trace) {
  hand_of_needle_[trace.header.stamp] = trace.time_ref;
  if (hand_of_needle_.size() > kCapacity) hand_of_needle_.erase(hand_of_needle_.begin());
  const auto waiting = force_waiting_.find(trace.header.stamp);
  if (waiting == force_waiting_.end()) return;
  if (trace.time_ref > last_hand_) {
    latencies_.add(secondsBetween(trace.time_ref, waiting->second));
    last_hand_ = trace.time_ref;
  }
  force_waiting_.erase(force_waiting_.begin(), std::next(waiting));
}

void LatencyMeter::onForce(const Trace& trace) {
  const auto hand = hand_of_needle_.find(trace.time_ref);
  if (hand == hand_of_needle_.end()) {
    // The needle's trace arrives later, or the needle moved by itself and the pose has no sample of
    // the hand.
    force_waiting_.emplace(trace.time_ref, trace.header.stamp);
    if (force_waiting_.size() > kCapacity) force_waiting_.erase(force_waiting_.begin());
    return;
  }
  if (hand->second <= last_hand_) return;  // this sample has been counted
  latencies_.add(secondsBetween(hand->second, trace.header.stamp));
  last_hand_ = hand->second;
}

}  // namespace microinjection
