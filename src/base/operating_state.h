#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// The operating states of CRTK and the commands that change them
/// (collaborative-robotics/documentation, docs/pages/api/operating-state.rst).
enum class OperatingState { kDisabled, kEnabled, kPaused, kFault };
enum class StateCommand { kEnable, kDisable, kPause, kResume, kHome, kUnhome };

/// Text on the topics operating_state and state_command: "ENABLED", ...; "enable", ...
const char* toText(OperatingState state);
const char* toText(StateCommand command);
/// The state, the command of that text; empty when there is none.
std::optional<OperatingState> operatingStateOf(const std::string& text);
std::optional<StateCommand> stateCommandOf(const std::string& text);

/// The state after a command; empty when the command is invalid, and the state stays.
///
///               enable    disable    pause    resume    home      unhome
///     DISABLED  ENABLED   DISABLED   .        .         .         DISABLED
///     ENABLED   ENABLED   DISABLED   PAUSED   .         ENABLED   ENABLED
///     PAUSED    .         DISABLED   PAUSED   ENABLED   .         PAUSED
///     FAULT     ENABLED   DISABLED   .        .         .         FAULT
///
/// From FAULT, `enable` is an attempt: the device stays in FAULT while the cause of the fault
/// persists. The first four columns are the convention's table. It does not define home and unhome;
/// theirs are from cisst's prmOperatingState, the convention's reference implementation.
std::optional<OperatingState> after(OperatingState state, StateCommand command);

/// The reason why a command is invalid in a state, with the states in which it is valid.
std::string refusalOf(OperatingState state, StateCommand command);

}  // namespace microinjection
