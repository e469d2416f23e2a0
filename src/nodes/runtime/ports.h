#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <boost/make_shared.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/command_source.h"
#include "nodes/runtime/finite_message.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {

/// Which message an input waits for in lock step: that of the same tick (from a node upstream) or that of the tick
/// before (feedback). Live, kThisTick means that an arrival sets off a step.
enum class InputPhase { kThisTick, kPreviousTick };

/// Beside each topic T that takes part in lock step runs T + kNoMessageSuffix, on which the publisher says in every
/// tick without a message that there is none, so that nobody waits for it. frame_id "invalid" also withdraws the last
/// one. Silence with stamp 0 is the publisher's greeting: nobody begins before all its publishers have greeted it.
constexpr char kNoMessageSuffix[] = "/silent";

/// One subscribed topic as a Cycle sees it.
class InputPort {
 public:
  InputPort(const std::string& name, InputPhase input_phase, double input_timeout)
      : topic(name), phase(input_phase), timeout(input_timeout) {}
  virtual ~InputPort() = default;

  /// Lock step: is the answer for the tick with this stamp there, message or silence?
  virtual bool answered(const ros::Time& stamp) const = 0;
  /// Lock step: makes that answer the present one, as of `now`.
  virtual void take(const ros::Time& stamp, const ros::Time& now) = 0;
  virtual bool valid() const = 0;
  /// Forgets the last message.
  virtual void invalidate() = 0;

  /// Age of the last message in s of ROS time, from its stamp or its arrival, whichever is older; infinite before the
  /// first.
  double age(const ros::Time& now) const { return received.isZero() ? INFINITY : secondsBetween(received, now); }
  /// The last message is there, valid and not older than `timeout`.
  bool fresh(const ros::Time& now) const { return !disconnected && valid() && age(now) >= 0 && age(now) <= timeout; }

  const std::string topic;
  const InputPhase phase;
  const double timeout;        ///< s of ROS time
  ros::Time received;          ///< of the last message
  std::string sender;          ///< node that the last message came from, whether it was taken or not
  std::string publisher_name;  ///< lock step: the node whose greeting is here, silence with stamp 0; empty: none yet
  bool disconnected = false;   ///< nothing counts as fresh; see Cycle
  /// kAny: listeners hear also what is stamped ahead; it is never fresh. kCommand: live, what has no stamp is taken as
  /// of its arrival, unless its publisher latches.
  StampRule stamp_rule = StampRule::kTimely;
};

/// How a message came, live.
struct Arrival {
  ros::Time time;
  ros::Time earliest;  ///< when it cannot have been here yet: a node that was frozen finds old messages
  std::string sender;
  bool latched = false;  ///< by its publisher
};

/// The newest message of a topic, for one thread. Measured data with stamp 0 is invalid (CRTK) and withdraws the one
/// before.
template <typename Message>
class Input : public InputPort {
 public:
  using InputPort::InputPort;
  using Pointer = boost::shared_ptr<const Message>;

  bool answered(const ros::Time& stamp) const override {
    const auto is_it = [&](const ros::Time& other) { return other == stamp; };
    return std::any_of(silence_.begin(), silence_.end(), [&](const auto& header) { return is_it(header.stamp); }) ||
           std::any_of(waiting_.begin(), waiting_.end(),
                       [&](const Waiting& waiting) { return is_it(waiting.message->header.stamp); });
  }

  void take(const ros::Time& stamp, const ros::Time& now) override {
    news_ = false;
    for (; !silence_.empty() && silence_.front().stamp <= stamp; silence_.pop_front()) {
      if (silence_.front().frame_id == "invalid") newest_.reset();
    }
    // A message that is not due yet must not hold those behind it back.
    for (auto next = waiting_.begin(); next != waiting_.end();) {
      if (next->message->header.stamp > stamp) {
        ++next;
        continue;
      }
      const Waiting due = std::move(*next);
      next = waiting_.erase(next);
      sender = due.sender;
      notify(*due.message, now);
      accept(due.message, now);
    }
  }

  /// Live. A message whose stamp is ahead is refused, and the last one stays.
  void receive(const Pointer& message, const Arrival& arrival) {
    sender = arrival.sender;
    if (message->header.stamp.isZero() && stamp_rule == StampRule::kCommand) return receiveUnstamped(*message, arrival);
    if (refuses(*message, arrival.time)) return;
    notify(*message, arrival.time);
    accept(message->header.stamp.isZero() ? nullptr : message, arrival.time);
  }
  void invalidate() override { newest_.reset(); }
  /// Lock step; see kNoMessageSuffix.
  void queue(const Pointer& message, const ros::Time& tick, const std::string& from) {
    if (message->header.stamp.isZero() || refuses(*message, tick)) return;
    waiting_.push_back({message, from});
  }
  void queueSilence(const std_msgs::Header& header, const std::string& publisher) {
    publisher_name = publisher;
    if (!header.stamp.isZero()) silence_.push_back(header);
  }

  /// Sees every message and when it came, also those that a newer one replaces before the next step.
  using Listener = std::function<void(const Message&, const ros::Time& now)>;
  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  bool valid() const override { return newest_ != nullptr; }
  /// The newest message if fresh(now), else null.
  const Message* get(const ros::Time& now) const { return fresh(now) ? newest_.get() : nullptr; }
  /// The newest message if it came since the last call of this function, else null: for commands.
  Pointer takeUpdates() { return std::exchange(news_, false) ? newest_ : nullptr; }

 private:
  struct Waiting {
    Pointer message;
    std::string sender;
  };

  void receiveUnstamped(const Message& message, const Arrival& arrival) {
    if (arrival.latched) return MessageRefusals::ofProcess().add(topic, kUnstampedLatched);
    const auto stamped = boost::make_shared<Message>(message);
    stamped->header.stamp = arrival.earliest;
    notify(*stamped, arrival.time);
    accept(stamped, arrival.time);
  }
  bool refuses(const Message& message, const ros::Time& now) const {
    if (stamp_rule != StampRule::kAny) return !isTimely(topic, message, now);
    if (!isAhead(message.header.stamp, now)) return false;
    notify(message, now);
    return true;
  }
  void notify(const Message& message, const ros::Time& now) const {
    for (const Listener& listener : listeners_) listener(message, now);
  }
  void accept(const Pointer& message, const ros::Time& now) {
    newest_ = message;
    // Whichever is older: a relay that repeats an old sample must not keep it fresh.
    received = message ? std::min(now, message->header.stamp) : now;
    news_ = message != nullptr;
  }

  Pointer newest_;
  bool news_ = false;
  std::vector<Listener> listeners_;
  std::deque<Waiting> waiting_;
  std::deque<std_msgs::Header> silence_;
};

/// One advertised topic as a Cycle sees it.
class OutputPort {
 public:
  explicit OutputPort(const std::string& name) : topic(name) {}
  virtual ~OutputPort() = default;

  /// Lock step: see kNoMessageSuffix.
  void announce() { silent_publisher.publish(std_msgs::Header()); }

  /// Lock step: every message is stamped with the tick that it was sent in.
  void beginTick(const ros::Time& now) { tick_ = now; }

  /// Lock step: says, at the end of the tick, that there was no message, where there was none.
  void endTick() {
    if (!published_) {
      std_msgs::Header header;
      header.stamp = tick_;
      if (invalid_) header.frame_id = "invalid";
      silent_publisher.publish(header);
    }
    published_ = invalid_ = false;
  }

  const std::string topic;
  ros::Publisher publisher;
  ros::Publisher silent_publisher;    ///< null when live
  std::atomic<unsigned> count{0};     ///< messages sent, for the diagnostics
  std::atomic<unsigned> withheld{0};  ///< messages whose numbers were not finite, for the diagnostics

 protected:
  ros::Time tick_;  ///< zero when live
  bool published_ = false;
  bool invalid_ = false;
};

template <typename Message>
class Output : public OutputPort {
 public:
  using OutputPort::OutputPort;

  /// The header's stamp is that of the measurement that the message derives from; see beginTick for lock step. A
  /// message with a number that is not finite is not sent: what goes out in its place is invalid. Live, a thread other
  /// than the node's may call it, always the same one.
  void publish(Message message) {
    if (!isFinite(message)) {
      ++withheld;
      return publishInvalid(std::move(message));
    }
    if (!tick_.isZero()) message.header.stamp = tick_;
    publisher.publish(message);
    published_ = true;
    ++count;
  }

  /// Sends the message with stamp 0: what was said before does not hold any more (CRTK).
  void publishInvalid(Message message) {
    if (!isFinite(message)) {
      Message empty;
      empty.header.frame_id = message.header.frame_id;
      message = std::move(empty);
    }
    message.header.stamp = ros::Time();
    publisher.publish(message);
    invalid_ = true;
    ++count;
  }
};

}  // namespace microinjection
