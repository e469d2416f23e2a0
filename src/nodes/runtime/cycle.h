#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/runtime/cycle_diagnostics.h"
#include "nodes/runtime/master_monitor.h"
#include "nodes/runtime/ports.h"
#include "nodes/runtime/stall_watch.h"

namespace microinjection {

/// Messages that may wait for a node that does not get the processor, five seconds of them: the recorder must see each
/// one.
constexpr int kBacklog = 5000;

/// When a node steps, and with which inputs. All callbacks and steps run in the one thread that calls run().
///
/// Live, a step follows the arrival of a kThisTick input, so that a hand's motion runs through the whole chain at once;
/// without such an input, or when it fails to come, the node steps at its own rate. In lock step (the parameter
/// /lockstep/participants names this node) it steps once for each tick of /clock, when each input has brought that
/// tick's message or said that it has none, and tells the clock; see nodes/lockstep_clock_node.h. An input whose
/// publisher_name has left the lock step is not waited for: it is silent, and grows stale.
///
/// While the master is lost (nodes/runtime/master_monitor.h) no input counts as fresh: a node then does what it does
/// without input. When the master has been away for long (MasterMonitor::masterLostForLong) and the node is at rest,
/// run() ends.
class Cycle {
 public:
  struct Tick {
    ros::Time now;
    double dt = 0;  ///< s since the step before, the nominal period in the first; ten periods at the most, so that
                    ///< a machine that stalls makes nothing leap
  };

  /// `rate` in Hz.
  Cycle(const ros::NodeHandle& node, double rate);

  /// References stay good for the life of the cycle. `timeout`: age in s past which the input is stale.
  template <typename Message>
  Input<Message>& input(const std::string& topic, InputPhase phase, double timeout);
  template <typename Message>
  Output<Message>& output(const std::string& topic, bool latch = false);

  /// A node handle whose callbacks run in this thread right before a step, for topics outside of the lock step.
  ros::NodeHandle& node() { return sampled_node_; }
  CycleDiagnostics& diagnostics() { return diagnostics_; }
  bool lockstep() const { return lockstep_; }
  bool masterLost() const { return master_lost_; }  ///< in this step
  double period() const { return period_; }         ///< s
  /// A message that is heard now cannot have come before; see StallWatch.
  ros::Time earliestArrival() const { return stalls_.earliest(); }

  /// Steps until ROS shuts down or stop() is called.
  void run(const std::function<void(const Tick&)>& step);
  void stop() { stopped_ = true; }
  /// Whether something moves or flows that this node must go on watching, even as an orphan; default false.
  void setBusy(bool busy) { busy_ = busy; }

 private:
  template <typename Message>
  Arrival arrivalOf(const ros::MessageEvent<const Message>& event) const {
    const ros::Time received = event.getReceiptTime(), earliest = stalls_.earliest();
    return {received, earliest.isZero() ? received : std::min(received, earliest), event.getPublisherName(),
            isLatched(event)};
  }
  bool shouldContinue();
  void runLive();
  void runLockstep();
  /// Lock step: has each input of that phase its answer for the tick `stamp`?
  bool answered(InputPhase phase, const ros::Time& stamp) const;
  bool readyFor(const ros::Time& tick) const;
  bool hasDeparted(const std::string& participant) const;
  /// Topics whose publishers have not announced themselves yet, each with a space before it.
  std::string inputsWithoutPublisher() const;
  /// It goes where the topic is remapped to.
  std::string silentTopic(const std::string& topic) const { return node_.resolveName(topic) + kNoMessageSuffix; }
  void checkMaster();
  void step(const ros::Time& now);
  void acknowledge(const ros::Time& now);

  double period_;
  bool stopped_ = false;
  bool busy_ = false;
  bool lockstep_ = false;
  ros::CallbackQueue queue_;          // what the node wakes up for
  ros::CallbackQueue sampled_queue_;  // what it looks at before a step: waking up for it would cost more than the step
  ros::NodeHandle node_;
  ros::NodeHandle sampled_node_;
  CycleDiagnostics diagnostics_;
  std::function<void(const Tick&)> step_;
  std::vector<std::unique_ptr<InputPort>> inputs_;
  std::vector<std::unique_ptr<OutputPort>> outputs_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Time last_step_;
  StallWatch stalls_;
  bool triggered_ = false;  // live: a kThisTick input has come
  ros::Time tick_;          // lock step: the clock's newest
  ros::Time stepped_tick_;  // lock step: the last one answered
  std::string departed_;    // lock step: as on kLeftTopic
  bool master_lost_ = false;
  MasterMonitor master_;
  ros::Publisher acknowledgement_;
};

template <typename Message>
Input<Message>& Cycle::input(const std::string& topic, InputPhase phase, double timeout) {
  auto owned = std::make_unique<Input<Message>>(topic, phase, timeout);
  Input<Message>& port = *owned;
  inputs_.push_back(std::move(owned));
  diagnostics_.monitor(port);
  const auto hints = ros::TransportHints().tcpNoDelay();
  using Event = ros::MessageEvent<const Message>;
  if (lockstep_) {
    const auto queue = [this, &port](const Event& event) {
      port.queue(event.getConstMessage(), tick_, event.getPublisherName());
    };
    subscribers_.push_back(node_.subscribe<Message, const Event&>(topic, 10, queue, {}, hints));
    using Silence = ros::MessageEvent<const std_msgs::Header>;
    const auto hear = [&port](const Silence& event) {
      port.queueSilence(*event.getConstMessage(), event.getPublisherName());
    };
    subscribers_.push_back(node_.subscribe<std_msgs::Header, const Silence&>(silentTopic(topic), 10, hear, {}, hints));
  } else {
    const bool trigger = phase == InputPhase::kThisTick;
    const auto receive = [this, &port, trigger](const Event& event) {
      // Listeners are the node's own code.
      runGuarded(port.topic, [&] { port.receive(event.getConstMessage(), arrivalOf(event)); });
      triggered_ = triggered_ || trigger;
    };
    subscribers_.push_back(
        (trigger ? node_ : sampled_node_).subscribe<Message, const Event&>(topic, kBacklog, receive, {}, hints));
  }
  return port;
}

template <typename Message>
Output<Message>& Cycle::output(const std::string& topic, bool latch) {
  auto owned = std::make_unique<Output<Message>>(topic);
  Output<Message>& port = *owned;
  outputs_.push_back(std::move(owned));
  diagnostics_.monitor(port);
  // In lock step every topic is latched: whoever connects late still gets the message of the tick that waits for it.
  port.publisher = node_.advertise<Message>(topic, 10, latch || lockstep_);
  if (lockstep_) port.silent_publisher = node_.advertise<std_msgs::Header>(silentTopic(topic), 10, true);
  return port;
}

}  // namespace microinjection
