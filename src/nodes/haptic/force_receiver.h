#pragma once

#include <ros/time.h>

#include <functional>
#include <string>

#include "nodes/runtime/cycle.h"

namespace microinjection {

/// Checks that the device receives the hand's force: the node that publishes the hand's position
/// must be connected to the force's topic. Other subscriptions do not count, since a watchdog, a
/// recorder or `rostopic echo` renders nothing.
class ForceReceiver {
 public:
  /// `required`: false for a device that renders no force.
  template <typename Message>
  ForceReceiver(const Cycle& cycle, const Publisher<Message>& force, bool required = true)
      : bus_(cycle.bus()),
        topic_(force.topic()),
        is_subscribed_([force](const std::string& node) { return force.isSubscribedBy(node); }),
        required_(required) {}
  ForceReceiver(const ForceReceiver&) = delete;

  /// Sets the topic of the hand's position.
  template <typename Message>
  void monitor(Input<Message>& position) {
    position.onMessage([this, &position](const Message&, const ros::Time&) { driver_ = position.sender; });
  }

  /// Checks the connection each 50 ms.
  bool isConnected();
  /// Why isConnected() was false; empty while it was true.
  const std::string& reason() const { return reason_; }
  /// The node that published the hand's last position; empty: none yet.
  const std::string& driver() const { return driver_; }

 private:
  const Bus& bus_;
  std::string topic_;  ///< of the force
  std::function<bool(const std::string& node)> is_subscribed_;
  bool required_;
  std::string driver_, checked_driver_;
  ros::SteadyTime checked_, connected_;  ///< times of the last check and connection; a new driver resets connected_
  std::string reason_;
};

}  // namespace microinjection
