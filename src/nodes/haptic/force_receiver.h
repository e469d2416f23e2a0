#pragma once

#include <ros/ros.h>

#include <string>

#include "nodes/runtime/ports.h"

namespace microinjection {

/// Whether the device feels the force that this node publishes for the hand: the node that publishes the hand's
/// position must be connected to the force's topic. Nobody else's subscription counts, since a watchdog, a recorder or
/// `rostopic echo` renders nothing.
///
/// In lock step it is not asked: who is connected first would depend on the machine.
class ForceReceiver {
 public:
  /// `asked`: false for a device that renders no force.
  ForceReceiver(const ros::Publisher& force, bool asked) : force_(force), asked_(asked) {}
  ForceReceiver(const ForceReceiver&) = delete;

  /// The topic of the hand's position.
  template <typename Message>
  void watch(Input<Message>& position) {
    position.onMessage([this, &position](const Message&, const ros::Time&) { driver_ = position.sender; });
  }

  /// Looks again each 50 ms.
  bool feels();
  /// Why feels() was false; empty while it was true.
  const std::string& why() const { return reason_; }
  /// The node that the hand's last position came from; empty: none yet.
  const std::string& driver() const { return driver_; }

 private:
  ros::Publisher force_;
  bool asked_;
  std::string driver_, looked_at_;
  ros::SteadyTime looked_, felt_;  ///< when last; felt_ from when this driver was new
  std::string reason_;
};

/// Whether a node is connected to a topic that this process publishes.
bool isSubscribed(const ros::Publisher& publisher, const std::string& node);

}  // namespace microinjection
