#pragma once

#include <ros/message_traits.h>

#include <cstdint>
#include <exception>
#include <memory>
#include <string>

#include "nodes/bus/bus.h"
#include "nodes/runtime/sole_sender.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

/// Whether a message's stamp is plausible. A stamp farther ahead than kLargestLead is refused and
/// reported. Messages without a header are always timely.
template <typename Message>
bool isTimely(MessageRefusals& refusals, const std::string& topic, const Message& message, const ros::Time& now) {
  const ros::Time* stamp = ros::message_traits::TimeStamp<Message>::pointer(message);
  if (!stamp || !isAhead(*stamp, now)) return true;
  refusals.add(topic, "its stamp is " + std::to_string(secondsBetween(now, *stamp)) + " s ahead of now");
  return false;
}

/// Runs a callback and reports its exceptions, which would otherwise end the node.
template <typename Callback>
void runGuarded(MessageRefusals& refusals, const std::string& topic, const Callback& callback) {
  try {
    callback();
  } catch (const std::exception& error) {
    refusals.add(topic, error.what());
  }
}

/// kAny is for commands that stop something: they are accepted with any stamp. kCommand is for
/// commands of a stream: without a stamp, the time of arrival counts.
enum class StampRule { kTimely, kAny, kCommand };

/// Like Bus::subscribe, for topics that are no Input of a Cycle: refuses messages whose stamp is ahead,
/// and reports the exceptions of `handler`, which receives the message and the name of its sender.
template <typename Message, typename Handler>
Subscription subscribeGuarded(Bus& bus, const std::string& topic, std::uint32_t queue_size, Handler handler,
                              StampRule rule = StampRule::kTimely, Serving serving = Serving::kSampled) {
  const auto receive = [&bus, topic, handler, rule](const Delivery<Message>& delivery) {
    runGuarded(bus.refusals(), topic, [&] {
      if (rule == StampRule::kTimely && !isTimely(bus.refusals(), topic, *delivery.message, bus.now())) return;
      handler(*delivery.message, delivery.raw.sender);
    });
  };
  return bus.subscribe<Message>(topic, queue_size, receive, serving);
}

/// Like subscribeGuarded, for what is measured, which one node sends: while two do, no message counts, and both are
/// named.
template <typename Message, typename Handler>
Subscription subscribeMeasured(Bus& bus, const std::string& topic, std::uint32_t queue_size, Handler handler) {
  const auto senders = std::make_shared<SoleSender>();
  return subscribeGuarded<Message>(bus, topic, queue_size,
                                   [&bus, topic, handler, senders](const auto& message, const auto& sender) {
                                     const std::string refusal = senders->refusalOf(sender, bus.now());
                                     refusal.empty() ? handler(message, sender) : bus.refusals().add(topic, refusal);
                                   });
}

}  // namespace microinjection
