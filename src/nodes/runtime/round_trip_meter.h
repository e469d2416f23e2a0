#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/TimeReference.h>

#include <Eigen/Core>
#include <map>

#include "base/interval_histogram.h"

namespace microinjection {

/// Time from a device's sample of the hand to the first force that depends on it and has come back to the device: what
/// all nodes between add, adapter and messages included. Joined by stamps, and from bridge to device by the size of the
/// force, since drivers' messages have no stamp. Only the needle poses that isTraced() picks are counted (see
/// latency_meter.h), and forces that are not zero.
class RoundTripMeter {
 public:
  explicit RoundTripMeter(ros::NodeHandle& node);

  /// A force (N) came to the device.
  void felt(const Eigen::Vector3d& force, const ros::Time& received);
  /// Counts what is old enough for all of its messages to have come; call it in every step.
  void step(const ros::Time& now);

  const IntervalHistogram& atBridge() const { return at_bridge_; }  ///< s, until the bridge's step began
  const IntervalHistogram& atDevice() const { return at_device_; }  ///< s, until the device has the force

 private:
  void count(const ros::Time& rendered, const ros::Time& needle);

  std::map<ros::Time, ros::Time> hand_of_needle_;   ///< stamps
  std::map<ros::Time, ros::Time> needle_of_force_;  ///< stamp of the needle's pose by that of the bridge's force
  std::map<ros::Time, Eigen::Vector3d> rendered_;   ///< N, by stamp of the bridge's force
  std::map<ros::Time, Eigen::Vector3d> felt_;       ///< N, by when it came
  ros::Time last_hand_;                             ///< newest hand sample that was counted
  IntervalHistogram at_bridge_, at_device_;
  ros::Subscriber setpoints_, forces_, traces_;
};

}  // namespace microinjection
