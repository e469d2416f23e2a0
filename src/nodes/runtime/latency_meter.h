#pragma once

#include <sensor_msgs/TimeReference.h>

#include <map>
#include <string>

#include "base/interval_histogram.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// Whether a needle pose is traced: about one in ten, the same in every node (stamps in every tenth
/// millisecond).
inline bool isTraced(const ros::Time& needle_stamp) { return needle_stamp.nsec / 1000000 % 10 == 0; }

/// A trace: the measurement of `source` at time_ref affected a node's output at header.stamp.
inline sensor_msgs::TimeReference toTrace(const ros::Time& done, const ros::Time& measured, const char* source) {
  sensor_msgs::TimeReference trace;
  trace.header.stamp = done;
  trace.time_ref = measured;
  trace.source = source;
  return trace;
}

/// Measures the time from a sample of the hand to the first force at the hand that depends on it.
/// It joins two traces: from the hand's sample to the needle's pose (/needle/setpoint_trace), and
/// from the needle's pose to the rendered force (/haptic/force_trace). isTraced() limits the poses,
/// because of the cost of messages at 1 kHz.
class LatencyMeter {
 public:
  explicit LatencyMeter(Bus& bus);
  const IntervalHistogram& latencies() const { return latencies_; }  ///< s

 private:
  using Trace = sensor_msgs::TimeReference;
  Subscription subscribe(Bus& bus, const std::string& topic, void (LatencyMeter::*handler)(const Trace&));
  void onSetpoint(const Trace& trace);
  void onForce(const Trace& trace);

  std::map<ros::Time, ros::Time> hand_of_needle_;  ///< stamp of the hand's sample by stamp of the needle's pose
  std::map<ros::Time, ros::Time> force_waiting_;   ///< time of rendering, by needle pose without a setpoint trace yet
  ros::Time last_hand_;                            ///< newest counted sample of the hand
  IntervalHistogram latencies_;
  Subscription setpoints_, forces_;
};

}  // namespace microinjection
