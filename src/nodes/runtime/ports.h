#pragma once

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

/// What an input is for its node. kDrives: it comes from upstream, and its arrival starts a step. kWakes:
/// feedback that starts a step live; in virtual time the next step reads it. kSampled: the next step
/// reads it.
enum class InputPhase { kDrives, kWakes, kSampled };

/// Each topic T in lock step has a second topic T + kNoMessageSuffix. On it the publisher reports
/// every tick without a message ("silence"), so that nobody waits for one. frame_id "invalid" also
/// withdraws the last message. Silence with stamp 0 is the publisher's greeting: a node starts when
/// all its publishers have sent theirs.
constexpr char kNoMessageSuffix[] = "/silent";

/// A subscribed topic, as used by Cycle.
class InputPort {
 public:
  InputPort(const std::string& name, InputPhase input_phase, double input_timeout, MessageRefusals& node_refusals)
      : topic(name), phase(input_phase), timeout(input_timeout), refusals(node_refusals) {}
  virtual ~InputPort() = default;

  /// Lock step: whether the message or silence of the tick with this stamp has arrived.
  virtual bool hasInputOf(const ros::Time& stamp) const = 0;
  /// Lock step: makes it the present input at `now`.
  virtual void receiveTick(const ros::Time& stamp, const ros::Time& now) = 0;
  virtual bool valid() const = 0;
  /// Discards the last message.
  virtual void invalidate() = 0;

  /// Age of the last message (s of ROS time), from the older of its stamp and its arrival; infinite
  /// before the first.
  double age(const ros::Time& now) const { return received.isZero() ? INFINITY : secondsBetween(received, now); }
  /// Whether the last message is valid and not older than `timeout`.
  bool fresh(const ros::Time& now) const { return !disconnected && valid() && age(now) >= 0 && age(now) <= timeout; }

  const std::string topic;
  const InputPhase phase;
  const double timeout;        ///< s of ROS time
  ros::Time received;          ///< of the last message
  std::string sender;          ///< node of the last message, also of a refused one
  std::string publisher_name;  ///< lock step: node that sent its greeting; empty: none yet
  bool disconnected = false;   ///< no message is fresh; see Cycle
  /// kAny: handlers also receive messages stamped ahead, which are never fresh. kCommand: live, a
  /// message without a stamp gets that of its arrival, unless its publisher latches.
  StampRule stamp_rule = StampRule::kTimely;
  MessageRefusals& refusals;
};

/// Arrival of a message, live.
struct Arrival {
  ros::Time time;
  ros::Time earliest;  ///< earliest possible arrival: a frozen node finds old messages
  std::string sender;
  bool latched = false;  ///< by its publisher
};

/// The newest message of a topic, for one thread. Measured data with stamp 0 is invalid (CRTK) and
/// withdraws the last message.
template <typename Message>
class Input : public InputPort {
 public:
  using InputPort::InputPort;
  using Pointer = boost::shared_ptr<const Message>;

  bool hasInputOf(const ros::Time& stamp) const override {
    const auto is_it = [&](const ros::Time& other) { return other == stamp; };
    return std::any_of(silence_.begin(), silence_.end(), [&](const auto& header) { return is_it(header.stamp); }) ||
           std::any_of(waiting_.begin(), waiting_.end(),
                       [&](const Waiting& waiting) { return is_it(waiting.message->header.stamp); });
  }

  void receiveTick(const ros::Time& stamp, const ros::Time& now) override {
    updated_ = false;
    for (; !silence_.empty() && silence_.front().stamp <= stamp; silence_.pop_front()) {
      if (silence_.front().frame_id == "invalid") newest_.reset();
    }
    // A message that is not due yet must not delay those behind it.
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

  /// Live. Refuses a message whose stamp is ahead; the last one stays.
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

  /// Receives every message with its time of arrival, also those that a newer one replaces before
  /// the next step.
  using Handler = std::function<void(const Message&, const ros::Time& now)>;
  void onMessage(Handler handler) { handlers_.push_back(std::move(handler)); }

  bool valid() const override { return newest_ != nullptr; }
  /// The newest message if fresh(now), else null.
  const Message* get(const ros::Time& now) const { return fresh(now) ? newest_.get() : nullptr; }
  /// The newest message if it arrived since the last call of this function, else null: for
  /// commands.
  Pointer takeUpdates() { return std::exchange(updated_, false) ? newest_ : nullptr; }

 private:
  struct Waiting {
    Pointer message;
    std::string sender;
  };

  void receiveUnstamped(const Message& message, const Arrival& arrival) {
    if (arrival.latched) return refusals.add(topic, kUnstampedLatched);
    const auto stamped = boost::make_shared<Message>(message);
    stamped->header.stamp = arrival.earliest;
    notify(*stamped, arrival.time);
    accept(stamped, arrival.time);
  }
  bool refuses(const Message& message, const ros::Time& now) const {
    if (stamp_rule != StampRule::kAny) return !isTimely(refusals, topic, message, now);
    if (!isAhead(message.header.stamp, now)) return false;
    notify(message, now);
    return true;
  }
  void notify(const Message& message, const ros::Time& now) const {
    for (const Handler& handler : handlers_) handler(message, now);
  }
  void accept(const Pointer& message, const ros::Time& now) {
    newest_ = message;
    // The older of the two: a relay that repeats an old sample must not keep it fresh.
    received = message ? std::min(now, message->header.stamp) : now;
    updated_ = message != nullptr;
  }

  Pointer newest_;
  bool updated_ = false;
  std::vector<Handler> handlers_;
  std::deque<Waiting> waiting_;
  std::deque<std_msgs::Header> silence_;
};

/// An advertised topic, as used by Cycle.
class OutputPort {
 public:
  explicit OutputPort(const std::string& name) : topic(name) {}
  virtual ~OutputPort() = default;

  virtual bool isSubscribedBy(const std::string& node) const = 0;
  /// Lock step: see kNoMessageSuffix.
  void announce() { silent_publisher.publish(std_msgs::Header()); }

  /// Lock step: every message is stamped with the tick in which it is published.
  void beginTick(const ros::Time& now) { tick_ = now; }

  /// Lock step: publishes the silence of a tick without a message.
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
  Publisher<std_msgs::Header> silent_publisher;  ///< null when live
  std::atomic<unsigned> count{0};                ///< published messages, for the diagnostics
  std::atomic<unsigned> withheld{0};             ///< messages with numbers that are not finite, for the diagnostics

 protected:
  ros::Time tick_;  ///< zero when live
  bool published_ = false;
  bool invalid_ = false;
};

template <typename Message>
class Output : public OutputPort {
 public:
  using OutputPort::OutputPort;

  bool isSubscribedBy(const std::string& node) const override { return publisher.isSubscribedBy(node); }

  /// The header's stamp is that of the message's measurement; see beginTick for lock step. A
  /// message with a number that is not finite is replaced by an invalid one. Live, another thread
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

  /// Publishes the message with stamp 0, which withdraws the last one (CRTK).
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

  Publisher<Message> publisher;
};

}  // namespace microinjection
