#pragma once

#include <ros/ros.h>
#include <sensor_msgs/TimeReference.h>

#include <map>
#include <string>

#include "base/interval_histogram.h"

namespace microinjection {

/// One needle pose in about ten, the same ones in every node: those of every tenth millisecond of their stamp.
inline bool isTraced(const ros::Time& needle_stamp) { return needle_stamp.nsec / 1000000 % 10 == 0; }

/// What was measured by `source` at time_ref shaped what a node did at header.stamp.
inline sensor_msgs::TimeReference toTrace(const ros::Time& done, const ros::Time& measured, const char* source) {
  sensor_msgs::TimeReference trace;
  trace.header.stamp = done;
  trace.time_ref = measured;
  trace.source = source;
  return trace;
}

/// Time from a sample of the hand to the first force at the hand that depends on it, joined from two traces: which hand
/// sample the needle's pose obeyed (/needle/setpoint_trace) and which needle pose the rendered force came from
/// (/haptic/force_trace).
/// Only the needle poses that isTraced() picks are traced: at 1 kHz every message counts.
class LatencyMeter {
 public:
  explicit LatencyMeter(ros::NodeHandle& node);
  const IntervalHistogram& latencies() const { return latencies_; }  ///< s

 private:
  using Trace = sensor_msgs::TimeReference;
  ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic, void (LatencyMeter::*handler)(const Trace&));
  void onSetpoint(const Trace& trace);
  void onForce(const Trace& trace);

  std::map<ros::Time, ros::Time> hand_of_needle_;  ///< stamp of the hand sample by stamp of the needle pose; recent
  std::map<ros::Time, ros::Time> force_waiting_;   ///< rendered at, by needle pose whose setpoint trace is to come
  ros::Time last_hand_;                            ///< newest hand sample that was counted
  IntervalHistogram latencies_;
  ros::Subscriber setpoints_, forces_;
};

}  // namespace microinjection
