#include "nodes/runtime/command_source.h"

#include <vector>

namespace microinjection {
namespace {

// s: an existing publisher repeats its last message as soon as it is connected; later messages are
// new.
constexpr double kConnecting = 5;

}  // namespace

RepeatedCommands::RepeatedCommands(const Bus& bus, const std::string& topic) : bus_(bus), begun_(bus.steady()) {
  const std::vector<std::string> publishers = bus.publishersOf(topic);
  older_.insert(publishers.begin(), publishers.end());
}

bool RepeatedCommands::mayBe(const CommandSource& command) {
  const auto last = last_.find(command.sender);
  const bool first = last == last_.end() || last->second.connection != command.connection;
  const bool repeated = last != last_.end() && last->second.number == command.number;
  const bool older =
      last == last_.end() && older_.count(command.sender) > 0 && secondsBetween(begun_, bus_.steady()) < kConnecting;
  last_[command.sender] = {command.connection, command.number};
  return command.unstamped && command.latched && first && (repeated || older);
}

}  // namespace microinjection
