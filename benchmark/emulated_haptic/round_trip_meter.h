#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/TimeReference.h>

#include <Eigen/Core>
#include <map>

#include "base/interval_histogram.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// Measures the time from a device's sample of the hand to the first force at the device that
/// depends on it: the delay of all nodes between them, with adapter and messages. Messages are
/// joined by stamps, and from bridge to device by the magnitude of the force, since drivers'
/// messages have no stamp. Only needle poses that isTraced() selects (latency_meter.h) and forces
/// other than zero count.
class RoundTripMeter {
 public:
  explicit RoundTripMeter(Bus& bus);

  /// Adds a force (N) that the device received.
  void addForce(const Eigen::Vector3d& force, const ros::Time& received);
  /// Counts round trips whose messages must all have arrived. Call in every step.
  void step(const ros::Time& now);

  const IntervalHistogram& atBridge() const { return at_bridge_; }  ///< s, until the bridge's step began
  const IntervalHistogram& atDevice() const { return at_device_; }  ///< s, until the device has the force

 private:
  void count(const ros::Time& rendered, const ros::Time& needle);

  std::map<ros::Time, ros::Time> hand_of_needle_;   ///< stamps
  std::map<ros::Time, ros::Time> needle_of_force_;  ///< stamp of the needle's pose by that of the bridge's force
  std::map<ros::Time, Eigen::Vector3d> rendered_;   ///< N, by stamp of the bridge's force
  std::map<ros::Time, Eigen::Vector3d> received_;   ///< N, by time of arrival
  ros::Time last_hand_;                             ///< newest counted sample of the hand
  IntervalHistogram at_bridge_, at_device_;
  Subscription setpoints_, forces_, traces_;
};

}  // namespace microinjection
