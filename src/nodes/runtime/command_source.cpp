#include "nodes/runtime/command_source.h"

#include <vector>

#include "nodes/runtime/lost_publishers.h"

namespace microinjection {
namespace {

// s: an existing publisher repeats its last message as soon as it is connected; later messages are
// new.
constexpr double kConnecting = 5;

/// Time (s) since this process first subscribed to commands.
double sinceSubscribed() {
  static const ros::SteadyTime begun = ros::SteadyTime::now();
  return secondsBetween(begun, ros::SteadyTime::now());
}

}  // namespace

RepeatedCommands::RepeatedCommands(const std::string& topic) {
  sinceSubscribed();
  const std::vector<std::string> publishers = publishersAtMaster()[topic];
  older_.insert(publishers.begin(), publishers.end());
}

bool RepeatedCommands::mayBe(const CommandSource& command) {
  const auto last = last_.find(command.sender);
  const bool first = last == last_.end() || last->second.connection != command.connection;
  const bool repeated = last != last_.end() && last->second.number == command.number;
  const bool older = last == last_.end() && older_.count(command.sender) > 0 && sinceSubscribed() < kConnecting;
  last_[command.sender] = {command.connection, command.number};
  return command.unstamped && command.latched && first && (repeated || older);
}

}  // namespace microinjection
