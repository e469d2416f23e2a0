#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <string>

#include "nodes/runtime/cycle_ports.h"
#include "nodes/runtime/pacing.h"

namespace microinjection {

/// Steps once for each tick of /clock: when each input has that tick's message or silence. Then it
/// acknowledges the tick; see nodes/lockstep_clock_node.h. It does not wait for an input whose
/// publisher has left the lock step: that input becomes stale.
class LockstepPacing {
 public:
  explicit LockstepPacing(CyclePorts& ports) : ports_(ports) {}

  template <typename Message>
  void subscribe(Input<Message>& port);
  /// Every topic is latched: a late subscriber still receives the message of the waiting tick.
  template <typename Message>
  void advertise(Output<Message>& port) {
    port.publisher = ports_.node.advertise<Message>(port.topic, 10, true);
    port.silent_publisher = ports_.node.advertise<std_msgs::Header>(silentTopic(port.topic), 10, true);
  }
  void run(const CycleSteps& steps);
  /// Whether the others go on without this node, because it was frozen.
  bool hasLeft() const { return hasDeparted(ros::this_node::getName()); }

 private:
  /// Follows the topic's remapping.
  std::string silentTopic(const std::string& topic) const { return ports_.node.resolveName(topic) + kNoMessageSuffix; }
  /// Whether each input of that phase has a message or silence for the tick `stamp`.
  bool hasInputOf(InputPhase phase, const ros::Time& stamp) const;
  bool isReady() const;
  bool hasDeparted(const std::string& participant) const;
  /// Topics whose publishers have not sent their greeting yet, each with a space before it.
  std::string inputsWithoutPublisher() const;
  void waitForPublishers(const CycleSteps& steps);
  /// Publishes what others wait for before the first tick: the greetings of all outputs and, when
  /// this node is ready, the acknowledgement of tick 0.
  void greet(bool ready);
  /// Once a second until the first tick: roscpp keeps a message for later subscribers only after it
  /// has sent it, so one that connects in between gets neither.
  void greetAgain(bool ready);
  void stepTick(const CycleSteps& steps);
  void acknowledge(const ros::Time& now);

  CyclePorts& ports_;
  ros::Time tick_;          // the clock's newest
  ros::Time stepped_tick_;  // the last acknowledged one
  std::string departed_;    // as on kLeftTopic
  ros::SteadyTime greeted_;
  ros::Publisher acknowledgement_;
};

template <typename Message>
void LockstepPacing::subscribe(Input<Message>& port) {
  using Event = ros::MessageEvent<const Message>;
  using Silence = ros::MessageEvent<const std_msgs::Header>;
  const auto hints = ros::TransportHints().tcpNoDelay();
  const auto queue = [this, &port](const Event& event) {
    port.queue(event.getConstMessage(), tick_, event.getPublisherName());
  };
  const auto receive_silence = [&port](const Silence& event) {
    port.queueSilence(*event.getConstMessage(), event.getPublisherName());
  };
  ports_.subscribers.push_back(ports_.node.subscribe<Message, const Event&>(port.topic, 10, queue, {}, hints));
  ports_.subscribers.push_back(
      ports_.node.subscribe<std_msgs::Header, const Silence&>(silentTopic(port.topic), 10, receive_silence, {}, hints));
}

}  // namespace microinjection
