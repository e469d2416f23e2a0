#pragma once

#include <ros/ros.h>

#include <algorithm>

#include "nodes/runtime/cycle_ports.h"
#include "nodes/runtime/pacing.h"

namespace microinjection {

/// Length of the message queues: five seconds without the processor, since the recorder must
/// receive each message.
constexpr int kBacklog = 5000;

/// Steps when a kThisTick input arrives, so that a hand's motion passes the whole chain at once.
/// Without such an input, or when it is late, the node steps at its own rate.
class LivePacing {
 public:
  LivePacing(CyclePorts& ports, double period) : ports_(ports), period_(period) {}  ///< s

  template <typename Message>
  void subscribe(Input<Message>& port);
  template <typename Message>
  void advertise(Output<Message>& port, bool latch) {
    port.publisher = ports_.node.advertise<Message>(port.topic, 10, latch);
  }
  void run(const CycleSteps& steps);

 private:
  template <typename Message>
  Arrival arrivalOf(const ros::MessageEvent<const Message>& event) const {
    const ros::Time received = event.getReceiptTime(), earliest = ports_.stalls.earliest();
    return {received, earliest.isZero() ? received : std::min(received, earliest), event.getPublisherName(),
            isLatched(event)};
  }

  CyclePorts& ports_;
  double period_;           // s
  bool triggered_ = false;  // a kThisTick input has arrived
};

template <typename Message>
void LivePacing::subscribe(Input<Message>& port) {
  using Event = ros::MessageEvent<const Message>;
  const bool trigger = port.phase == InputPhase::kThisTick;
  const auto receive = [this, &port, trigger](const Event& event) {
    // The handlers of an input are the node's own code and may throw.
    runGuarded(port.topic, [&] { port.receive(event.getConstMessage(), arrivalOf(event)); });
    triggered_ = triggered_ || trigger;
  };
  ros::NodeHandle& node = trigger ? ports_.node : ports_.sampled_node;
  ports_.subscribers.push_back(
      node.subscribe<Message, const Event&>(port.topic, kBacklog, receive, {}, ros::TransportHints().tcpNoDelay()));
}

}  // namespace microinjection
