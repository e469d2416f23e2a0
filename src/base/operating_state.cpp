#include "base/operating_state.h"

#include <array>
#include <cstddef>

namespace microinjection {
namespace {

using State = OperatingState;
using Next = std::optional<OperatingState>;

constexpr std::array<State, 4> kStates{State::kDisabled, State::kEnabled, State::kPaused, State::kFault};
constexpr std::array<const char*, 4> kStateNames{"DISABLED", "ENABLED", "PAUSED", "FAULT"};
constexpr std::array<StateCommand, 6> kCommands{StateCommand::kEnable, StateCommand::kDisable, StateCommand::kPause,
                                                StateCommand::kResume, StateCommand::kHome,    StateCommand::kUnhome};
constexpr std::array<const char*, 6> kCommandNames{"enable", "disable", "pause", "resume", "home", "unhome"};

}  // namespace

const char* toText(OperatingState state) { return kStateNames[static_cast<std::size_t>(state)]; }

const char* toText(StateCommand command) { return kCommandNames[static_cast<std::size_t>(command)]; }

std::optional<OperatingState> operatingStateOf(const std::string& text) {
  for (const OperatingState state : kStates) {
    if (text == toText(state)) return state;
  }
  return std::nullopt;
}

std::optional<StateCommand> stateCommandOf(const std::string& text) {
  for (const StateCommand command : kCommands) {
    if (text == toText(command)) return command;
  }
  return std::nullopt;
}

/// The convention's table has "PAUSED (invalid)" for `enable` in PAUSED: a pause ends explicitly,
/// by `resume` or `disable`. cisst's prmOperatingState refuses `enable` there, too.
std::optional<OperatingState> after(OperatingState state, StateCommand command) {
  static const Next kTable[4][6] = {
      {State::kEnabled, State::kDisabled, {}, {}, {}, State::kDisabled},
      {State::kEnabled, State::kDisabled, State::kPaused, {}, State::kEnabled, State::kEnabled},
      {{}, State::kDisabled, State::kPaused, State::kEnabled, {}, State::kPaused},
      {State::kEnabled, State::kDisabled, {}, {}, {}, State::kFault}};
  return kTable[static_cast<std::size_t>(state)][static_cast<std::size_t>(command)];
}

std::string refusalOf(OperatingState state, StateCommand command) {
  std::string allowed;
  for (const State other : kStates) {
    if (after(other, command)) allowed += (allowed.empty() ? "" : ", ") + std::string(toText(other));
  }
  return std::string("state is ") + toText(state) + ", " + toText(command) + " is allowed in " + allowed;
}

}  // namespace microinjection
