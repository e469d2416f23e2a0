#pragma once

#include <ros/message_event.h>
#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "nodes/runtime/message_guard.h"

namespace microinjection {

/// Whether the publisher of a message latches: it sends its last message, of any age, to each new
/// subscriber.
template <typename Message>
bool isLatched(const ros::MessageEvent<const Message>& event) {
  const auto& header = event.getConnectionHeader();
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

/// Why an unstamped motion command of a publisher that latches is refused.
constexpr char kUnstampedLatched[] = "it has no stamp and its publisher latches: it may be an old one";

/// s: an older command does not start a motion. A restarted node receives latched commands again,
/// which must not move the needle a second time.
constexpr double kOldestCommand = 3;

/// Origin of a command. CRTK allows commands without a stamp; the released crtk_python_client
/// (1.4.0) sends such.
struct CommandSource {
  std::string sender;                           ///< node
  bool unstamped = false;                       ///< stamp 0
  bool latched = false;                         ///< by its publisher
  std::uint32_t number = 0;                     ///< header.seq, the publisher's message counter
  boost::shared_ptr<ros::M_string> connection;  ///< the same for all messages of a connection
};

/// Detects old commands that a latching publisher repeats: to a restarted node, or after a broken
/// connection. Only the first message of a connection can be one. It counts as old when its
/// publisher existed before this node subscribed, or sent the same number on an earlier connection.
class RepeatedCommands {
 public:
  /// Requests the topic's present publishers from the master. Call before subscribing.
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

/// Like subscribeGuarded, for commands: calls `handler` with the message and its CommandSource.
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
