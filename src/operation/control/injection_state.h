#pragma once

#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// State of an injection, the same by hand and by the controller.
enum class InjectionState {
  kIdle,
  kApproach,
  kContact,
  kIndent,
  kPunctured,
  kInject,
  kWithdraw,
  kFault,
  kAspirate,
  kHold,
  kRelease
};
constexpr std::array<InjectionState, 11> kInjectionStates = {
    InjectionState::kIdle,      InjectionState::kApproach, InjectionState::kContact,  InjectionState::kIndent,
    InjectionState::kPunctured, InjectionState::kInject,   InjectionState::kWithdraw, InjectionState::kFault,
    InjectionState::kAspirate,  InjectionState::kHold,     InjectionState::kRelease};

/// Events: detected (touch, lost, puncture, injected, out), decided (start, indent, inject,
/// withdraw) or failures.
enum class InjectionEvent {
  kStart,     ///< the needle starts
  kHold,      ///< the holding pipette takes the cell
  kRelease,   ///< it lets it go, or shall
  kTouch,     ///< force along the pipette above the noise
  kLost,      ///< the touch was noise
  kIndent,    ///< the needle goes into the cell, or shall
  kAspirate,  ///< the needle rests and draws the membrane in, or shall
  kPuncture,  ///< the force fell suddenly while the needle advanced, or the membrane broke by suction
  kInject,    ///< the injector works, or shall
  kInjected,  ///< it has finished
  kWithdraw,  ///< the needle goes back, or shall
  kOut,       ///< it is back, and the cell let go if it shall be
  kFail,      ///< the rig does not execute its commands
  kReset      ///< DISABLED, or enabled anew
};

/// Whether the needle rests before or behind its way, while the holding pipette takes the cell or lets it go.
constexpr bool needleWaits(InjectionState state) {
  return state == InjectionState::kHold || state == InjectionState::kRelease;
}

/// Names for people and topics: "idle", "approach", ...
const char* toText(InjectionState state);
/// The state of that name; empty: none.
std::optional<InjectionState> injectionStateOf(const std::string& name);

/// The state after an event; empty: the event has no effect.
///
///             start     touch    lost      indent  puncture   inject  injected   withdraw  out
///     idle      approach  .        .         .       .          .       .          .         .
///     approach  .         contact  .         .       .          .       .          withdraw  .
///     contact   .         .        approach  indent  punctured  .       .          withdraw  .
///     indent    .         .        .         .       punctured  .       .          withdraw  .
///     aspirate  .         .        .         indent  punctured  .       .          withdraw  .
///     punctured .         .        .         indent  punctured  inject  .          withdraw  .
///     inject    .         .        .         .       .          .       punctured  withdraw  .
///     withdraw  .         contact  .         .       .          .       .          withdraw  idle
///     fault     .         .        .         .       .          .       .          .         .
///
/// aspirate leads from indent to aspirate; hold from idle to hold, from where start and withdraw lead on, and out back;
/// release from idle and withdraw to release, from where out leads to idle and withdraw to withdraw. In every state,
/// fail leads to fault and reset to idle. punctured -> indent is for the next layer, withdraw -> contact for a hand
/// that reverses.
std::optional<InjectionState> after(InjectionState state, InjectionEvent event);

}  // namespace microinjection
