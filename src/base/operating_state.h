#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// The operating states of CRTK and the commands that lead from one to another (collaborative-robotics/documentation,
/// docs/pages/api/operating-state.rst).
enum class OperatingState { kDisabled, kEnabled, kPaused, kFault };
enum class StateCommand { kEnable, kDisable, kPause, kResume, kHome, kUnhome };

/// Words of the topics operating_state and state_command: "ENABLED", ...; "enable", ...
const char* toText(OperatingState state);
const char* toText(StateCommand command);
/// The command of that word; empty where there is none.
std::optional<StateCommand> stateCommandOf(const std::string& word);

/// The state after a command; empty where the command is invalid, and the state stays.
///
///               enable    disable    pause    resume    home      unhome
///     DISABLED  ENABLED   DISABLED   .        .         .         DISABLED
///     ENABLED   ENABLED   DISABLED   PAUSED   .         ENABLED   ENABLED
///     PAUSED    .         DISABLED   PAUSED   ENABLED   .         PAUSED
///     FAULT     ENABLED   DISABLED   .        .         .         FAULT
///
/// From FAULT it is an attempt: who has a cause of the fault that persists stays there. The first four columns are the
/// convention's table. It leaves home and unhome open; theirs are those of cisst's prmOperatingState, the convention's
/// reference implementation.
std::optional<OperatingState> after(OperatingState state, StateCommand command);

/// Why a command is invalid in a state, and in which states it is valid.
std::string refusalOf(OperatingState state, StateCommand command);

}  // namespace microinjection
