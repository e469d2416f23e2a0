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
#include "nodes/runtime/stall_monitor.h"

namespace microinjection {

/// Length of the message queues: five seconds without the processor, since the recorder must
/// receive each message.
constexpr int kBacklog = 5000;

/// Decides when a node steps, and with which inputs. All callbacks and steps run in the thread that
/// calls run().
///
/// - Live, a step follows the arrival of a kThisTick input, so that a hand's motion passes the
///   whole chain at once. Without such an input, or when it is late, the node steps at its own
///   rate.
/// - In lock step (the parameter /lockstep/participants contains this node) the node steps once for
///   each tick of /clock. It waits until each input has that tick's message or silence, and
///   acknowledges the tick; see nodes/lockstep_clock_node.h. It does not wait for an input whose
///   publisher has left the lock step: that input becomes stale.
///
/// While the master is lost (nodes/runtime/master_monitor.h) no input is fresh. When the master is
/// lost for long (MasterMonitor::masterLostForLong) and the node is at rest, run() ends.
class Cycle {
 public:
  struct Tick {
    ros::Time now;
    double dt = 0;  ///< s since the last step, at first the nominal period; at most ten periods, so that
                    ///< nothing jumps after a stall of the machine
  };

  /// `rate` in Hz.
  Cycle(const ros::NodeHandle& node, double rate);

  /// References are valid for the life of the cycle. `timeout`: age (s) past which the input is
  /// stale.
  template <typename Message>
  Input<Message>& input(const std::string& topic, InputPhase phase, double timeout);
  template <typename Message>
  Output<Message>& output(const std::string& topic, bool latch = false);

  /// A node handle for topics outside of the lock step: its callbacks run in this thread right
  /// before a step.
  ros::NodeHandle& node() { return sampled_node_; }
  CycleDiagnostics& diagnostics() { return diagnostics_; }
  bool lockstep() const { return lockstep_; }
  bool masterLost() const { return master_lost_; }  ///< in this step
  double period() const { return period_; }         ///< s
  /// Earliest arrival of a message that is received now; see StallMonitor.
  ros::Time earliestArrival() const { return stalls_.earliest(); }

  /// Steps until ROS shuts down or stop() is called.
  void run(const std::function<void(const Tick&)>& step);
  void stop() { stopped_ = true; }
  /// Whether something moves or flows that this node must monitor even when the master is lost for
  /// long; default false.
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
  /// Lock step: whether each input of that phase has a message or silence for the tick `stamp`.
  bool hasInputOf(InputPhase phase, const ros::Time& stamp) const;
  bool readyFor(const ros::Time& tick) const;
  bool hasDeparted(const std::string& participant) const;
  /// Topics whose publishers have not sent their greeting yet, each with a space before it.
  std::string inputsWithoutPublisher() const;
  /// Follows the topic's remapping.
  std::string silentTopic(const std::string& topic) const { return node_.resolveName(topic) + kNoMessageSuffix; }
  void checkMaster();
  void step(const ros::Time& now);
  void acknowledge(const ros::Time& now);

  double period_;
  bool stopped_ = false;
  bool busy_ = false;
  bool lockstep_ = false;
  ros::CallbackQueue queue_;          // wakes the node up
  ros::CallbackQueue sampled_queue_;  // read before a step: to wake up for it would cost more than the step
  ros::NodeHandle node_;
  ros::NodeHandle sampled_node_;
  CycleDiagnostics diagnostics_;
  std::function<void(const Tick&)> step_;
  std::vector<std::unique_ptr<InputPort>> inputs_;
  std::vector<std::unique_ptr<OutputPort>> outputs_;
  std::vector<ros::Subscriber> subscribers_;
  ros::Time last_step_;
  StallMonitor stalls_;
  bool triggered_ = false;  // live: a kThisTick input has arrived
  ros::Time tick_;          // lock step: the clock's newest
  ros::Time stepped_tick_;  // lock step: the last acknowledged one
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
    const auto receive_silence = [&port](const Silence& event) {
      port.queueSilence(*event.getConstMessage(), event.getPublisherName());
    };
    subscribers_.push_back(
        node_.subscribe<std_msgs::Header, const Silence&>(silentTopic(topic), 10, receive_silence, {}, hints));
  } else {
    const bool trigger = phase == InputPhase::kThisTick;
    const auto receive = [this, &port, trigger](const Event& event) {
      // The handlers of an input are the node's own code and may throw.
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
  // In lock step every topic is latched: a late subscriber still receives the message of the
  // waiting tick.
  port.publisher = node_.advertise<Message>(topic, 10, latch || lockstep_);
  if (lockstep_) port.silent_publisher = node_.advertise<std_msgs::Header>(silentTopic(topic), 10, true);
  return port;
}

}  // namespace microinjection
