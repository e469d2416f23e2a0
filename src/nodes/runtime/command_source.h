#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "nodes/runtime/message_guard.h"

namespace microinjection {

/// Why an unstamped motion command of a publisher that latches is refused.
constexpr char kUnstampedLatched[] = "it has no stamp and its publisher latches: it may be an old one";

/// s: an older command does not start a motion. A restarted node receives latched commands again,
/// which must not move the needle a second time.
constexpr double kOldestCommand = 3;

/// Origin of a command. CRTK allows commands without a stamp; the released crtk_python_client
/// (1.4.0) sends such.
struct CommandSource {
  std::string sender;                        ///< node
  bool unstamped = false;                    ///< stamp 0
  bool latched = false;                      ///< by its publisher
  std::uint32_t number = 0;                  ///< header.seq, the publisher's message counter
  boost::shared_ptr<const void> connection;  ///< the same for all messages of a connection
};

/// Detects old commands that a latching publisher repeats: to a restarted node, or after a broken
/// connection. Only the first message of a connection can be one. It counts as old when its
/// publisher existed before this node subscribed, or sent the same number on an earlier connection.
class RepeatedCommands {
 public:
  /// Asks for the topic's present publishers. Call before subscribing.
  RepeatedCommands(const Bus& bus, const std::string& topic);
  bool mayBe(const CommandSource& command);

 private:
  struct Last {
    boost::shared_ptr<const void> connection;
    std::uint32_t number = 0;
  };
  const Bus& bus_;
  ros::SteadyTime begun_;             ///< about when this node subscribed
  std::set<std::string> older_;       ///< nodes that published the topic before this node subscribed
  std::map<std::string, Last> last_;  ///< by node
};

/// Like subscribeGuarded, for commands: calls `handler` with the message and its CommandSource.
template <typename Message, typename Handler>
Subscription subscribeCommand(Bus& bus, const std::string& topic, Handler handler,
                              StampRule rule = StampRule::kTimely) {
  const auto receive = [&bus, topic, handler, rule](const Delivery<Message>& delivery) {
    runGuarded(bus.refusals(), topic, [&] {
      const Message& message = *delivery.message;
      if (rule != StampRule::kAny && !isTimely(bus.refusals(), topic, message, bus.now())) return;
      handler(message, CommandSource{delivery.raw.sender, message.header.stamp.isZero(), delivery.raw.latched,
                                     message.header.seq, delivery.raw.connection});
    });
  };
  return bus.subscribe<Message>(topic, 10, receive);
}

}  // namespace microinjection
