#include "nodes/latency_meter.h"

namespace microinjection {
namespace {

constexpr std::size_t kRemembered = 200;  // traced needle poses, two seconds of them

}  // namespace

LatencyMeter::LatencyMeter(ros::NodeHandle& node)
    : setpoints_(node.subscribe("needle/setpoint_trace", 100, &LatencyMeter::onSetpoint, this,
                                ros::TransportHints().tcpNoDelay())),
      forces_(node.subscribe("haptic/force_trace", 100, &LatencyMeter::onForce, this,
                             ros::TransportHints().tcpNoDelay())) {}

void LatencyMeter::onSetpoint(const cell_microinjection::LatencyTraceConstPtr& trace) {
  hand_of_needle_[trace->header.stamp] = trace->origin;
  if (hand_of_needle_.size() > kRemembered) hand_of_needle_.erase(hand_of_needle_.begin());
  const auto waiting = force_waiting_.find(trace->header.stamp);
  if (waiting == force_waiting_.end()) return;
  if (trace->origin > last_hand_) {
    latencies_.add((waiting->second - trace->origin).toSec());
    last_hand_ = trace->origin;
  }
  force_waiting_.erase(force_waiting_.begin(), std::next(waiting));
}

void LatencyMeter::onForce(const cell_microinjection::LatencyTraceConstPtr& trace) {
  const auto hand = hand_of_needle_.find(trace->origin);
  if (hand == hand_of_needle_.end()) {
    // The needle's trace is on its way, or the needle moved of itself and no hand sample belongs to the pose.
    force_waiting_.emplace(trace->origin, trace->header.stamp);
    if (force_waiting_.size() > kRemembered) force_waiting_.erase(force_waiting_.begin());
    return;
  }
  if (hand->second <= last_hand_) return;  // this hand sample has been felt before
  latencies_.add((trace->header.stamp - hand->second).toSec());
  last_hand_ = hand->second;
}

}  // namespace microinjection
