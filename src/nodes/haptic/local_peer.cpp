#include "nodes/haptic/local_peer.h"

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/latency_meter.h"

namespace microinjection {

LocalPeer::LocalPeer(Cycle& cycle, const PeerTimeouts& timeouts, const ForceSourceConfig& source, bool quiet_sensor,
                     Output<sensor_msgs::TimeReference>& trace)
    : inputs_(cycle, timeouts, source, quiet_sensor),
      target_(cycle.output<geometry_msgs::PoseStamped>("teleop/servo_cp")),
      trace_(trace) {}

void LocalPeer::read(HapticBridge::Input& input, const Cycle::Tick& tick) {
  const PeerInputs::Reading reading = inputs_.read(tick.now);
  controller_ = reading.controller;
  if (!controller_) return;  // without it the needle does not follow the hand
  input.needle = reading.needle;
  input.force = reading.force;
}

void LocalPeer::send(const std::optional<Eigen::Vector3d>& target, const ros::Time& measured, const Cycle::Tick& tick) {
  if (!target) return withdraw(tick.now);
  target_.publish(toPose(*target, measured, kWorldFrame));
  const ros::Time force = inputs_.forceStamp(tick.now);
  if (isTraced(force)) trace_.publish(toTrace(tick.now, force, "needle"));
}

void LocalPeer::withdraw(const ros::Time& now) {
  target_.publishInvalid(toPose(Eigen::Vector3d::Zero(), now, kWorldFrame));
}

}  // namespace microinjection
