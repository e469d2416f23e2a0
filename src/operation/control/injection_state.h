#pragma once

#include <array>
#include <optional>
#include <string>

namespace microinjection {

/// Where an injection is. Who moves the needle (a hand or the controller) makes no difference to it.
enum class InjectionState { kIdle, kApproach, kContact, kIndent, kPunctured, kInject, kWithdraw, kFault };
constexpr std::array<InjectionState, 8> kInjectionStates = {
    InjectionState::kIdle,      InjectionState::kApproach, InjectionState::kContact,  InjectionState::kIndent,
    InjectionState::kPunctured, InjectionState::kInject,   InjectionState::kWithdraw, InjectionState::kFault};

/// What takes it on: seen (touch, lost, puncture, injected, out), decided (start, indent, inject, withdraw) or failed.
enum class InjectionEvent {
  kStart,     ///< the needle sets out
  kTouch,     ///< force along the pipette above the noise
  kLost,      ///< that was noise
  kIndent,    ///< the needle is to go into the cell, or does
  kPuncture,  ///< the force fell suddenly while the needle advanced
  kInject,    ///< the injector is to work, or does
  kInjected,  ///< it has finished
  kWithdraw,  ///< the needle is to go back, or does
  kOut,       ///< it is back
  kFail,      ///< the rig does not do what it is told
  kReset      ///< DISABLED, or enabled anew
};
constexpr std::array<InjectionEvent, 11> kInjectionEvents = {
    InjectionEvent::kStart,    InjectionEvent::kTouch,  InjectionEvent::kLost,     InjectionEvent::kIndent,
    InjectionEvent::kPuncture, InjectionEvent::kInject, InjectionEvent::kInjected, InjectionEvent::kWithdraw,
    InjectionEvent::kOut,      InjectionEvent::kFail,   InjectionEvent::kReset};

/// Words for people and topics: "idle", "approach", ...; "start", "touch", ...
const char* toText(InjectionState state);
const char* toText(InjectionEvent event);
/// The state of that word; empty where there is none.
std::optional<InjectionState> injectionStateOf(const std::string& word);

/// The state after an event; empty where the event means nothing, and the state stays.
///
///             start     touch    lost      indent  puncture   inject  injected   withdraw  out
///     idle      approach  .        .         .       .          .       .          .         .
///     approach  .         contact  .         .       .          .       .          withdraw  .
///     contact   .         .        approach  indent  punctured  .       .          withdraw  .
///     indent    .         .        .         .       punctured  .       .          withdraw  .
///     punctured .         .        .         indent  punctured  inject  .          withdraw  .
///     inject    .         .        .         .       .          .       punctured  withdraw  .
///     withdraw  .         contact  .         .       .          .       .          withdraw  idle
///     fault     .         .        .         .       .          .       .          .         .
///
/// fail leads to fault and reset to idle from anywhere. punctured -> indent is for the next layer; withdraw -> contact
/// for a hand that goes back in.
std::optional<InjectionState> after(InjectionState state, InjectionEvent event);

}  // namespace microinjection
