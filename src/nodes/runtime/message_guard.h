#pragma once

#include <ros/message_event.h>
#include <ros/message_traits.h>
#include <ros/ros.h>

#include <cstdint>
#include <exception>
#include <string>

#include "nodes/runtime/message_refusals.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Whether a message's stamp is plausible. A stamp farther ahead than kLargestLead is refused and
/// reported. Messages without a header are always timely.
template <typename Message>
bool isTimely(const std::string& topic, const Message& message, const ros::Time& now) {
  const ros::Time* stamp = ros::message_traits::TimeStamp<Message>::pointer(message);
  if (!stamp || !isAhead(*stamp, now)) return true;
  MessageRefusals::ofProcess().add(topic,
                                   "its stamp is " + std::to_string(secondsBetween(now, *stamp)) + " s ahead of now");
  return false;
}

/// Runs a callback and reports its exceptions, which would otherwise end the node.
template <typename Callback>
void runGuarded(const std::string& topic, const Callback& callback) {
  try {
    callback();
  } catch (const std::exception& error) {
    MessageRefusals::ofProcess().add(topic, error.what());
  }
}

/// kAny is for commands that stop something: they are accepted with any stamp. kCommand is for
/// commands of a stream: without a stamp, the time of arrival counts.
enum class StampRule { kTimely, kAny, kCommand };

/// Like NodeHandle::subscribe, for topics that are no Input of a Cycle: refuses messages whose
/// stamp is ahead, and reports the exceptions of `handler`, which receives the message and the name
/// of its sender.
template <typename Message, typename Handler>
ros::Subscriber subscribeGuarded(ros::NodeHandle node, const std::string& topic, std::uint32_t queue_size,
                                 Handler handler, StampRule rule = StampRule::kTimely) {
  using Event = ros::MessageEvent<const Message>;
  const auto receive = [topic, handler, rule](const Event& event) {
    runGuarded(topic, [&] {
      const Message& message = *event.getConstMessage();
      if (rule == StampRule::kTimely && !isTimely(topic, message, ros::Time::now())) return;
      handler(message, event.getPublisherName());
    });
  };
  return node.subscribe<Message, const Event&>(topic, queue_size, receive, {}, ros::TransportHints().tcpNoDelay());
}

}  // namespace microinjection
