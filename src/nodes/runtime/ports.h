#pragma once

#include <boost/make_shared.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/runtime/command_source.h"
#include "nodes/runtime/finite_message.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/sole_sender.h"

namespace microinjection {

/// What an input is for its node. kDrives: it comes from upstream, and its arrival starts a step. kWakes:
/// feedback that starts a step live; in virtual time the next step reads it. kSampled: the next step
/// reads it.
enum class InputPhase { kDrives, kWakes, kSampled };

/// A subscribed topic, as used by Cycle.
class InputPort {
 public:
  InputPort(const std::string& name, InputPhase input_phase, double input_timeout, MessageRefusals& node_refusals)
      : topic(name), phase(input_phase), timeout(input_timeout), refusals(node_refusals) {}
  virtual ~InputPort() = default;

  virtual bool valid() const = 0;
  /// Discards the last message.
  virtual void invalidate() = 0;

  /// Age of the last message (s of ROS time), from the older of its stamp and its arrival; infinite
  /// before the first.
  double age(const ros::Time& now) const { return received.isZero() ? INFINITY : secondsBetween(received, now); }
  /// Whether the last message is valid, not older than `timeout`, from the only sender, and of a source that lives.
  bool fresh(const ros::Time& now) const {
    return !disconnected && repeats.empty() && valid() && age(now) >= 0 && age(now) <= timeout && rivals(now).empty();
  }
  /// The two nodes that both send now, of which nobody can know which one is right; empty: one does.
  std::string rivals(const ros::Time& now) const {
    if (!one_sender || !senders.hasOther()) return "";
    const bool has_changes_only = std::isinf(timeout);
    return senders.rivals(now, has_changes_only && subscription.publishers() > 1);
  }

  const std::string topic;
  const InputPhase phase;
  const double timeout;  ///< s of ROS time
  ros::Time received;    ///< of the last message
  std::string sender;    ///< node of the last message, also of a refused one
  SoleSender senders;
  bool one_sender = true;     ///< else several nodes may send: commands, whose authority the node checks itself
  bool disconnected = false;  ///< no message is fresh; see Cycle
  bool optional = false;      ///< nobody need send it: before the first message nothing is reported
  std::string repeats;        ///< what its source repeats, see Repetition: no message is fresh; empty: it lives
  /// kAny: handlers also receive messages stamped ahead, which are never fresh. kCommand: live, a
  /// message without a stamp gets that of its arrival, unless its publisher latches.
  StampRule stamp_rule = StampRule::kTimely;
  MessageRefusals& refusals;
  Subscription subscription;  ///< that fills it
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

  /// Refuses a message whose stamp is ahead; the last one stays.
  void receive(const Pointer& message, const Arrival& arrival) {
    sender = arrival.sender;
    senders.receive(arrival.sender, arrival.time);
    if (message->header.stamp.isZero() && stamp_rule == StampRule::kCommand) return receiveUnstamped(*message, arrival);
    if (refuses(*message, arrival.time)) return;
    notify(*message, arrival.time);
    accept(message->header.stamp.isZero() ? nullptr : message, arrival.time);
  }
  void invalidate() override { newest_.reset(); }
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
};

/// An advertised topic, as used by Cycle.
class OutputPort {
 public:
  explicit OutputPort(const std::string& name) : topic(name) {}
  virtual ~OutputPort() = default;

  const std::string topic;
  std::atomic<unsigned> count{0};     ///< published messages, for the diagnostics
  std::atomic<unsigned> withheld{0};  ///< messages with numbers that are not finite, for the diagnostics
};

template <typename Message>
class Output : public OutputPort {
 public:
  using OutputPort::OutputPort;

  /// The header's stamp is that of the message's measurement. A
  /// message with a number that is not finite is replaced by an invalid one. Another thread
  /// than the node's may call it, always the same one.
  void publish(Message message) {
    if (!isFinite(message)) {
      ++withheld;
      return publishInvalid(std::move(message));
    }
    publisher.publish(message);
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
    ++count;
  }

  Publisher<Message> publisher;
};

}  // namespace microinjection
