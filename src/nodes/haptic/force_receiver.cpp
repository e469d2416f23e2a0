#include "nodes/haptic/force_receiver.h"

#include <ros/console.h>

namespace microinjection {
namespace {

const ros::WallDuration kConnectionCheckPeriod(0.05);
const ros::WallDuration kConnectingTime(2);  // until all nodes of a session are connected

}  // namespace

bool ForceReceiver::isConnected() {
  const ros::SteadyTime now = bus_.steady();
  if (!required_ || driver_.empty()) return true;
  if (driver_ == checked_driver_ && now - checked_ < kConnectionCheckPeriod) return reason_.empty();
  const bool connected = is_subscribed_(driver_);
  if (connected || driver_ != checked_driver_) connected_ = now;
  checked_driver_ = driver_;
  checked_ = now;
  reason_ = connected ? "" : driver_ + " does not subscribe to the hand's force, " + topic_;
  if (now - connected_ > kConnectingTime) {
    ROS_WARN_STREAM_THROTTLE(10, reason_ << ": without the force the needle does not follow the hand");
  }
  return connected;
}

}  // namespace microinjection
