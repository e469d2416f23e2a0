#pragma once

#include <std_msgs/Header.h>

#include <functional>
#include <string>

#include "nodes/bus/ros_bus.h"
#include "nodes/runtime/cycle_ports.h"

namespace microinjection {

/// Steps once for each tick of /clock: when each input has that tick's message or silence. Then it
/// acknowledges the tick; see nodes/lockstep_clock_node.h. It does not wait for an input whose
/// publisher has left the lock step: that input becomes stale.
class LockstepPacing {
 public:
  LockstepPacing(CyclePorts& ports, Bus& bus);

  template <typename Message>
  void subscribe(Input<Message>& port);
  /// Every topic is latched: a late subscriber still receives the message of the waiting tick.
  template <typename Message>
  void advertise(Output<Message>& port) {
    port.publisher = bus_.advertise<Message>(port.topic, 10, true);
    port.silent_publisher = bus_.advertise<std_msgs::Header>(silentTopic(port.topic), 10, true);
  }
  /// Has the bus run this instead of its own steps.
  void takeOver(std::function<void(const ros::Time&)> step);
  /// Whether the others go on without this node, because it was frozen.
  bool hasLeft() const { return hasDeparted(bus_.name()); }

 private:
  /// Follows the topic's remapping.
  std::string silentTopic(const std::string& topic) const { return bus_.resolve(topic) + kNoMessageSuffix; }
  /// Whether each input of that kind (of this tick, or of the last one) has a message or silence for the tick `stamp`.
  bool hasInputOf(bool of_this_tick, const ros::Time& stamp) const;
  bool isReady() const;
  bool hasDeparted(const std::string& participant) const;
  /// Topics whose publishers have not sent their greeting yet, each with a space before it.
  std::string inputsWithoutPublisher() const;
  void waitForPublishers();
  /// Publishes what others wait for before the first tick: the greetings of all outputs and, when
  /// this node is ready, the acknowledgement of tick 0.
  void greet(bool ready);
  /// Once a second until the first tick: roscpp keeps a message for later subscribers only after it
  /// has sent it, so one that connects in between gets neither.
  void greetAgain(bool ready);
  void stepTick();
  void acknowledge(const ros::Time& now);

  bool shouldContinue() const;
  void run();

  CyclePorts& ports_;
  RosBus& bus_;
  std::function<void(const ros::Time&)> step_;
  ros::Time tick_;          // the clock's newest
  ros::Time stepped_tick_;  // the last acknowledged one
  std::string departed_;    // as on kLeftTopic
  ros::SteadyTime greeted_;
  Publisher<std_msgs::Header> acknowledgement_;
};

template <typename Message>
void LockstepPacing::subscribe(Input<Message>& port) {
  const auto queue = [this, &port](const Delivery<Message>& delivery) {
    port.queue(delivery.message, tick_, delivery.raw.sender);
  };
  const auto receive_silence = [&port](const Delivery<std_msgs::Header>& delivery) {
    port.queueSilence(*delivery.message, delivery.raw.sender);
  };
  ports_.subscriptions.push_back(bus_.subscribe<Message>(port.topic, 10, queue, Serving::kDrives));
  ports_.subscriptions.push_back(
      bus_.subscribe<std_msgs::Header>(silentTopic(port.topic), 10, receive_silence, Serving::kDrives));
}

}  // namespace microinjection
