#pragma once

#include <array>
#include <string>

#include "operation/console/session_view.h"

namespace microinjection {

/// The console's buttons, from top to bottom.
enum class ConsoleCommand {
  kEnable,
  kHome,
  kHold,
  kApproach,
  kIndent,
  kAspirate,
  kInject,
  kWithdraw,
  kRelease,
  kDisable,
  kStop
};
constexpr std::array<ConsoleCommand, 11> kConsoleCommands = {
    ConsoleCommand::kEnable,  ConsoleCommand::kHome,     ConsoleCommand::kHold,   ConsoleCommand::kApproach,
    ConsoleCommand::kIndent,  ConsoleCommand::kAspirate, ConsoleCommand::kInject, ConsoleCommand::kWithdraw,
    ConsoleCommand::kRelease, ConsoleCommand::kDisable,  ConsoleCommand::kStop};
/// A session without a holder has no such button.
constexpr bool needsHolder(ConsoleCommand command) {
  return command == ConsoleCommand::kHold || command == ConsoleCommand::kRelease;
}

/// What a button does now.
struct CommandOffer {
  std::string label;    ///< on the button
  std::string command;  ///< for /controller/state_command
  std::string effect;   ///< for people
  std::string refusal;  ///< why the button is greyed; empty: it is not
};

/// The offer of a button in a state of the session. The refusals are the controller's own
/// (InjectionController::command), as far as its messages show them, so that a button is not greyed
/// while the controller would accept its command. Two buttons are greyed beyond that because they
/// would change nothing: enable while ENABLED, disable while DISABLED.
///
/// Enable sends `resume` while the controller is PAUSED, as the keys of the haptic devices do.
///
/// Stop is never greyed. It sends `pause`, which holds the needle at its set-point and keeps the
/// injection: `resume`, `withdraw` and `home` remain possible. A pulse goes on through `pause`, and
/// PAUSED or DISABLED controllers ignore or refuse it; stop then sends `disable`, which also ends the
/// pulse. Without a message of the controller it sends `disable`, which is allowed in every state.
CommandOffer offer(ConsoleCommand command, const SessionView& session);

}  // namespace microinjection
