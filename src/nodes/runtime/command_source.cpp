#include "nodes/runtime/command_source.h"

#include <XmlRpc.h>
#include <ros/master.h>

namespace microinjection {
namespace {

// s: a publisher that was there before sends its last message as soon as it is connected; what comes later is new.
constexpr double kConnecting = 5;

/// s since this process subscribed to commands first.
double sinceSubscribed() {
  static const ros::SteadyTime begun = ros::SteadyTime::now();
  return secondsBetween(begun, ros::SteadyTime::now());
}

}  // namespace

RepeatedCommands::RepeatedCommands(const std::string& topic) {
  sinceSubscribed();
  XmlRpc::XmlRpcValue arguments, answer, state;
  arguments[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", arguments, answer, state, false)) return;
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int i = 0; i < publishers.size(); ++i) {
    if (static_cast<std::string>(publishers[i][0]) != topic) continue;
    for (int j = 0; j < publishers[i][1].size(); ++j) older_.insert(static_cast<std::string>(publishers[i][1][j]));
  }
}

bool RepeatedCommands::mayBe(const CommandSource& command) {
  const auto known = last_.find(command.sender);
  const bool first = known == last_.end() || known->second.connection != command.connection;
  const bool told_before = known != last_.end() && known->second.number == command.number;
  const bool older = known == last_.end() && older_.count(command.sender) > 0 && sinceSubscribed() < kConnecting;
  last_[command.sender] = {command.connection, command.number};
  return command.unstamped && command.latched && first && (told_before || older);
}

}  // namespace microinjection
