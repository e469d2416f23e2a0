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

/// The guards of this file keep a message that somebody else sent wrongly from ending, fooling or stopping a node. On
/// a topic any node of the network may publish, and roscpp checks nothing but the type: a stamp of next year would
/// outdate all later ones, an exception in a callback would end the process that holds a needle, and a second
/// publisher of a measurement would be believed in turn with the first. A guard drops such a message, says so on
/// /diagnostics (MessageRefusals), and the node goes on.
///
///     subscribeCommand    a command: with its origin                  (command_source.h)
///     subscribeMeasured   what one node measures: from one sender  --+
///     subscribeGuarded    any other message                        --+--> isTimely, runGuarded --> handler
///     Cycle::input        an input of steps (ports.h)              --+

/// Whether a message's stamp is plausible. A stamp farther ahead of `now` than kLargestLead is refused and reported.
/// Messages without a header are always timely. An old stamp is no fault here: Input::fresh() judges age.
template <typename Message>
bool isTimely(MessageRefusals& refusals, const std::string& topic, const Message& message, const ros::Time& now) {
  const ros::Time* stamp = ros::message_traits::TimeStamp<Message>::pointer(message);
  if (!stamp || !isAhead(*stamp, now)) return true;
  refusals.add(topic, "its stamp is " + std::to_string(secondsBetween(now, *stamp)) + " s ahead of now");
  return false;
}

/// Runs a callback and reports its exceptions by the topic, which would otherwise end the node.
template <typename Callback>
void runGuarded(MessageRefusals& refusals, const std::string& topic, const Callback& callback) {
  try {
    callback();
  } catch (const std::exception& error) {
    refusals.add(topic, error.what());
  }
}

/// Which stamps a subscription accepts. To ignore a stop because a clock is wrong would be worse than to obey an old
/// one; so what stops is kAny.
///
///                 more than 1 s ahead                          0
///     kTimely     refused                                      taken; an Input takes it as "no measurement" (CRTK)
///     kCommand    refused by an Input, else as kAny            an Input gives it the time of its arrival
///     kAny        taken, but never fresh as an Input           as kTimely
enum class StampRule { kTimely, kAny, kCommand };

/// Like Bus::subscribe, for topics that are no Input of a Cycle: refuses messages whose stamp is ahead (with
/// kTimely), and reports the exceptions of `handler`: void(const Message&, const std::string& sender). `bus` outlives
/// the subscription.
template <typename Message, typename Handler>
Subscription subscribeGuarded(Bus& bus, const std::string& topic, std::uint32_t queue_size, Handler handler,
                              StampRule rule = StampRule::kTimely, Serving serving = Serving::kSampled) {
  const auto receive = [&bus, topic, handler, rule](const Delivery<Message>& delivery) {
    runGuarded(bus.refusals(), topic, [&] {
      if (rule != StampRule::kAny && !isTimely(bus.refusals(), topic, *delivery.message, bus.now())) return;
      handler(*delivery.message, delivery.raw.sender);
    });
  };
  return bus.subscribe<Message>(topic, queue_size, receive, serving);
}

/// The same for a member function of a node, or of a part of it, which outlives the subscription.
template <typename Owner, typename Message>
Subscription subscribeGuarded(Bus& bus, const std::string& topic, std::uint32_t queue_size,
                              void (Owner::*handler)(const Message&), Owner* owner, StampRule rule = StampRule::kTimely,
                              Serving serving = Serving::kSampled) {
  const auto call = [owner, handler](const Message& message, const std::string&) { (owner->*handler)(message); };
  return subscribeGuarded<Message>(bus, topic, queue_size, call, rule, serving);
}

/// Like subscribeGuarded, for what is measured, which one node sends. While two nodes do, nobody can know which of
/// them is right: no message counts, and both are named (SoleSender).
template <typename Message, typename Handler>
Subscription subscribeMeasured(Bus& bus, const std::string& topic, std::uint32_t queue_size, Handler handler) {
  const auto senders = std::make_shared<SoleSender>();
  return subscribeGuarded<Message>(bus, topic, queue_size,
                                   [&bus, topic, handler, senders](const auto& message, const auto& sender) {
                                     const std::string refusal = senders->refusalOf(sender, bus.now());
                                     refusal.empty() ? handler(message, sender) : bus.refusals().add(topic, refusal);
                                   });
}

/// The same for a member function; see subscribeGuarded.
template <typename Owner, typename Message>
Subscription subscribeMeasured(Bus& bus, const std::string& topic, std::uint32_t queue_size,
                               void (Owner::*handler)(const Message&), Owner* owner) {
  const auto call = [owner, handler](const Message& message, const std::string&) { (owner->*handler)(message); };
  return subscribeMeasured<Message>(bus, topic, queue_size, call);
}

}  // namespace microinjection
