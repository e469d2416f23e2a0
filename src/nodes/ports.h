#pragma once

#include <ros/ros.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace microinjection {

/// Which message an input waits for in lock step: that of the same tick (from a node upstream) or that of the tick
/// before (feedback). Live, kSameTick means that an arrival sets off a step.
enum class Phase { kSameTick, kTickBefore };

/// Beside each topic T that takes part in lock step runs T + kSilentSuffix, on which the publisher says in every tick
/// without a message that there is none, so that nobody waits for it. frame_id "invalid" also withdraws the last one.
/// Silence with stamp 0 is the publisher's greeting: nobody begins before all its publishers have greeted it.
constexpr char kSilentSuffix[] = "/silent";

/// One subscribed topic as a Cycle sees it.
class InputPort {
 public:
  InputPort(const std::string& name, Phase input_phase, double input_timeout)
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
  double age(const ros::Time& now) const { return received.isZero() ? INFINITY : (now - received).toSec(); }
  /// The last message is there, valid and not older than `timeout`.
  bool fresh(const ros::Time& now) const { return !cut_off && valid() && age(now) >= 0 && age(now) <= timeout; }

  const std::string topic;
  const Phase phase;
  const double timeout;  ///< s of ROS time
  ros::Time received;    ///< of the last message
  std::string feeder;    ///< lock step: the node whose greeting is here, silence with stamp 0; empty: none yet
  bool cut_off = false;  ///< nothing counts as fresh; see Cycle
};

/// The newest message of a topic, for one thread. A message with stamp 0 is invalid (CRTK) and withdraws the one
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
                       [&](const auto& message) { return is_it(message->header.stamp); });
  }

  void take(const ros::Time& stamp, const ros::Time& now) override {
    news_ = false;
    for (; !silence_.empty() && silence_.front().stamp <= stamp; silence_.pop_front()) {
      if (silence_.front().frame_id == "invalid") newest_.reset();
    }
    for (; !waiting_.empty() && waiting_.front()->header.stamp <= stamp; waiting_.pop_front()) {
      tell(*waiting_.front(), now);
      accept(waiting_.front(), now);
    }
  }

  /// Live, a message that came at `now`.
  void receive(const Pointer& message, const ros::Time& now) {
    tell(*message, now);
    accept(message->header.stamp.isZero() ? nullptr : message, now);
  }
  void invalidate() override { newest_.reset(); }
  /// Lock step; see kSilentSuffix.
  void queue(const Pointer& message) {
    if (!message->header.stamp.isZero()) waiting_.push_back(message);
  }
  void queueSilence(const std_msgs::Header& header, const std::string& publisher) {
    feeder = publisher;
    if (!header.stamp.isZero()) silence_.push_back(header);
  }

  /// Sees every message and when it came, also those that a newer one replaces before the next step.
  using Listener = std::function<void(const Message&, const ros::Time& now)>;
  void listen(Listener listener) { listeners_.push_back(std::move(listener)); }

  bool valid() const override { return newest_ != nullptr; }
  /// The newest message if fresh(now), else null.
  const Message* get(const ros::Time& now) const { return fresh(now) ? newest_.get() : nullptr; }
  /// The newest message if it came since the last call of this function, else null: for commands.
  Pointer takeNews() { return std::exchange(news_, false) ? newest_ : nullptr; }

 private:
  void tell(const Message& message, const ros::Time& now) const {
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
  std::deque<Pointer> waiting_;
  std::deque<std_msgs::Header> silence_;
};

/// One advertised topic as a Cycle sees it.
class OutputPort {
 public:
  explicit OutputPort(const std::string& name) : topic(name) {}
  virtual ~OutputPort() = default;

  /// Lock step: see kSilentSuffix.
  void greet() { silent_publisher.publish(std_msgs::Header()); }

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
  ros::Publisher silent_publisher;  ///< null when live
  std::atomic<unsigned> count{0};   ///< messages sent, for the diagnostics

 protected:
  ros::Time tick_;  ///< zero when live
  bool published_ = false;
  bool invalid_ = false;
};

template <typename Message>
class Output : public OutputPort {
 public:
  using OutputPort::OutputPort;

  /// The header's stamp is that of the measurement that the message derives from; see beginTick for lock step. Live, a
  /// thread other than the node's may call it, always the same one.
  void publish(Message message) {
    if (!tick_.isZero()) message.header.stamp = tick_;
    publisher.publish(message);
    published_ = true;
    ++count;
  }

  /// Sends the message with stamp 0: what was said before does not hold any more (CRTK).
  void publishInvalid(Message message) {
    message.header.stamp = ros::Time();
    publisher.publish(message);
    invalid_ = true;
    ++count;
  }
};

}  // namespace microinjection
