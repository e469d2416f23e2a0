#include "operation/control/injection_state.h"

namespace microinjection {

const char* toText(InjectionState state) {
  constexpr const char* kWords[] = {"idle",     "approach", "contact",  "indent", "punctured", "inject",
                                    "withdraw", "fault",    "aspirate", "hold",   "release"};
  return kWords[static_cast<int>(state)];
}

std::optional<InjectionState> injectionStateOf(const std::string& name) {
  for (const InjectionState state : kInjectionStates) {
    if (name == toText(state)) return state;
  }
  return std::nullopt;
}

std::optional<InjectionState> after(InjectionState state, InjectionEvent event) {
  using State = InjectionState;
  using Event = InjectionEvent;
  struct Transition {
    State from;
    Event event;
    State to;
  };
  constexpr Transition kTable[] = {
      {State::kIdle, Event::kStart, State::kApproach},
      {State::kApproach, Event::kTouch, State::kContact},
      {State::kApproach, Event::kWithdraw, State::kWithdraw},
      {State::kContact, Event::kLost, State::kApproach},
      {State::kContact, Event::kIndent, State::kIndent},
      {State::kContact, Event::kPuncture, State::kPunctured},
      {State::kContact, Event::kWithdraw, State::kWithdraw},
      {State::kIndent, Event::kPuncture, State::kPunctured},
      {State::kIndent, Event::kWithdraw, State::kWithdraw},
      {State::kPunctured, Event::kIndent, State::kIndent},
      {State::kPunctured, Event::kPuncture, State::kPunctured},
      {State::kPunctured, Event::kInject, State::kInject},
      {State::kPunctured, Event::kWithdraw, State::kWithdraw},
      {State::kInject, Event::kInjected, State::kPunctured},
      {State::kInject, Event::kWithdraw, State::kWithdraw},
      {State::kWithdraw, Event::kTouch, State::kContact},
      {State::kWithdraw, Event::kWithdraw, State::kWithdraw},
      {State::kWithdraw, Event::kOut, State::kIdle},
      {State::kIndent, Event::kAspirate, State::kAspirate},
      {State::kAspirate, Event::kIndent, State::kIndent},
      {State::kAspirate, Event::kPuncture, State::kPunctured},
      {State::kAspirate, Event::kWithdraw, State::kWithdraw},
      {State::kIdle, Event::kHold, State::kHold},
      {State::kHold, Event::kStart, State::kApproach},
      {State::kHold, Event::kWithdraw, State::kWithdraw},
      {State::kIdle, Event::kRelease, State::kRelease},
      {State::kWithdraw, Event::kRelease, State::kRelease},
      {State::kRelease, Event::kOut, State::kIdle},
      {State::kHold, Event::kOut, State::kIdle},
      {State::kRelease, Event::kWithdraw, State::kWithdraw},
  };
  if (event == Event::kReset) return State::kIdle;
  if (event == Event::kFail) return State::kFault;
  for (const Transition& transition : kTable) {
    if (transition.from == state && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

}  // namespace microinjection
