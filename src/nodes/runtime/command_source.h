#pragma once

#include <ros/message_event.h>
#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "nodes/runtime/message_guard.h"

namespace microinjection {

/// Whether the publisher of a message latches: it sends its last message, however old, to whoever connects.
template <typename Message>
bool isLatched(const ros::MessageEvent<const Message>& event) {
  const auto& header = event.getConnectionHeader();
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

/// Why an unstamped motion command of a publisher that latches is refused.
constexpr char kUnstampedLatched[] = "it has no stamp and its publisher latches: it may be an old one";

/// A command as it came. CRTK lets commands be without a stamp; the released crtk_python_client (1.4.0) sends them so.
struct CommandSource {
  std::string sender;                           ///< node
  bool unstamped = false;                       ///< stamp 0
  bool latched = false;                         ///< by its publisher
  std::uint32_t number = 0;                     ///< header.seq: counts the messages of this publisher
  boost::shared_ptr<ros::M_string> connection;  ///< the same for all messages of a connection
};

/// Finds commands that are said again and not anew: what a publisher that latches sends when it is connected, to a node
/// that starts anew or after a line that broke. Only the first message of a connection can be one. It is taken for old
/// when its publisher was there before this node subscribed, or has sent the same number on an earlier connection.
class RepeatedCommands {
 public:
  /// Asks the master who publishes the topic now: to be called before subscribing.
  explicit RepeatedCommands(const std::string& topic);
  bool mayBe(const CommandSource& command);

 private:
  struct Last {
    boost::shared_ptr<ros::M_string> connection;
    std::uint32_t number = 0;
  };
  std::set<std::string> older_;       ///< nodes that published the topic before this node subscribed
  std::map<std::string, Last> last_;  ///< by node
};

/// As subscribeGuarded, for commands: `handler` is called with the message and its CommandSource.
template <typename Message, typename Handler>
ros::Subscriber subscribeCommand(ros::NodeHandle node, const std::string& topic, Handler handler,
                                 StampRule rule = StampRule::kTimely) {
  using Event = ros::MessageEvent<const Message>;
  const auto receive = [topic, handler, rule](const Event& event) {
    runGuarded(topic, [&] {
      const Message& message = *event.getConstMessage();
      if (rule == StampRule::kTimely && !isTimely(topic, message, ros::Time::now())) return;
      handler(message, CommandSource{event.getPublisherName(), message.header.stamp.isZero(), isLatched(event),
                                     message.header.seq, event.getConnectionHeaderPtr()});
    });
  };
  return node.subscribe<Message, const Event&>(topic, 10, receive, {}, ros::TransportHints().tcpNoDelay());
}

}  // namespace microinjection
