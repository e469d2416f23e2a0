#include "operation/console/console_commands.h"

namespace microinjection {
namespace {

constexpr char kNoController[] = "injection_controller is silent";
constexpr char kDeaf[] = "injection_controller does not receive commands yet";

std::string stateIs(const SessionView& session) { return std::string("state is ") + toText(*session.operating); }

bool inIdle(const SessionView& session) { return *session.injection == InjectionState::kIdle; }

/// In the state idle the controller moves by itself only while it homes.
bool homing(const SessionView& session) { return session.busy && inIdle(session); }

/// The depth is 0 until the needle touches the cell and again when it starts anew.
bool touched(const SessionView& session) { return session.depth != 0; }

CommandOffer enableOffer(const SessionView& session) {
  if (session.operating == OperatingState::kPaused) {
    return {"Resume", "resume", "continues from the pause", ""};
  }
  CommandOffer result{"Enable", "enable", "lets the controller move the needle", ""};
  if (session.operating == OperatingState::kEnabled) result.refusal = "it is enabled";
  return result;
}

std::string refusalOfHome(const SessionView& session) {
  const bool allowed = session.operating == OperatingState::kEnabled || session.operating == OperatingState::kPaused;
  return allowed ? "" : stateIs(session) + ", home is allowed in ENABLED, PAUSED";
}

std::string refusalOfApproach(const SessionView& session) {
  if (session.byHand()) return "mode is manual: the hand moves the needle";
  if (session.operating != OperatingState::kEnabled) return stateIs(session) + ", an injection starts in ENABLED";
  if (!session.homed) return "not homed; allowed after home";
  if (homing(session)) return "an injection starts in idle, the needle is in homing";
  if (!inIdle(session)) {
    return std::string("an injection starts in idle, the needle is in ") + toText(*session.injection);
  }
  if (touched(session)) return "the needle is in the cell; withdraw or home takes it out";
  return "";
}

std::string refusalOfStep(const SessionView& session, InjectionState from, bool is_pulse) {
  if (session.operating != OperatingState::kEnabled) return stateIs(session) + ", it is allowed in ENABLED";
  if (!session.homed) return "not homed; allowed after home";
  const std::string no_step = std::string("it is no step from ") + toText(*session.injection);
  if (session.byHand()) {
    if (!is_pulse) return "mode is manual: the hand moves the needle";
    if (session.injection != from) return no_step;
    return session.settings.has_pulse ? "" : "the goal has no pulse";
  }
  if (session.settings.mode == "automatic") return "mode is automatic: the injection needs no command";
  if (inIdle(session)) return "no injection is under way";
  if (from == InjectionState::kIndent && !session.settings.has_suction) return "the goal has no suction";
  const bool injected = session.volume > 0 && session.injection != InjectionState::kInject;
  if (is_pulse && injected) return "it is injected already";
  if (!session.waits) return no_step + " yet";
  return session.injection == from ? "" : no_step;
}

std::string refusalOfHold(const SessionView& session) {
  if (!session.settings.has_holder) return "there is no holder";
  if (!session.settings.holds) return "the goal has no suction to hold with";
  if (!session.byHand()) return refusalOfApproach(session);
  return session.operating == OperatingState::kEnabled ? "" : stateIs(session) + ", it is allowed in ENABLED";
}

std::string refusalOfRelease(const SessionView& session) {
  if (!session.settings.has_holder) return "there is no holder";
  if (session.injection == InjectionState::kRelease) return refusalOfStep(session, InjectionState::kRelease, false);
  if (session.operating != OperatingState::kEnabled) return stateIs(session) + ", it is allowed in ENABLED";
  if ((!session.byHand() && !inIdle(session)) || touched(session))
    return "the needle may be in the cell; a cell is let go in idle, with the needle out";
  return "";
}

std::string refusalOfWithdraw(const SessionView& session) {
  if (session.byHand()) return "mode is manual: the hand withdraws the needle, or home";
  const bool held = session.operating == OperatingState::kEnabled || session.operating == OperatingState::kPaused;
  if (!held) return stateIs(session) + ", withdraw is allowed in ENABLED and PAUSED";
  if (homing(session)) return "there is nothing to withdraw from in homing";
  if (inIdle(session) && touched(session)) return "";
  if (after(*session.injection, InjectionEvent::kWithdraw)) return "";
  return std::string("there is nothing to withdraw from in ") + toText(*session.injection);
}

CommandOffer stopOffer(const SessionView& session) {
  const bool pause = session.operating == OperatingState::kEnabled && session.connected() &&
                     session.injection != InjectionState::kInject;
  if (pause) return {"STOP", "pause", "holds the needle; again: disables", ""};
  return {"STOP", "disable", "holds the needle, ends a pulse and disables", ""};
}

CommandOffer describe(ConsoleCommand command) {
  switch (command) {
    case ConsoleCommand::kHome:
      return {"Home", "home", "withdraws the needle, then pauses", ""};
    case ConsoleCommand::kHold:
      return {"Hold", "hold", "the holding pipette takes the cell", ""};
    case ConsoleCommand::kRelease:
      return {"Release", "release", "the holding pipette lets the cell go", ""};
    case ConsoleCommand::kApproach:
      return {"Approach", "approach", "starts an injection", ""};
    case ConsoleCommand::kIndent:
      return {"Indent", "indent", "moves into the cell until a membrane fails", ""};
    case ConsoleCommand::kAspirate:
      return {"Aspirate", "aspirate", "draws the membrane in until it breaks", ""};
    case ConsoleCommand::kInject:
      return {"Inject", "inject", "starts the pulse", ""};
    case ConsoleCommand::kWithdraw:
      return {"Withdraw", "withdraw", "takes the needle out of the cell", ""};
    default:
      return {"Disable", "disable", "ends the injection and holds the needle", ""};
  }
}

std::string refusalOf(ConsoleCommand command, const SessionView& session) {
  switch (command) {
    case ConsoleCommand::kHome:
      return refusalOfHome(session);
    case ConsoleCommand::kHold:
      return refusalOfHold(session);
    case ConsoleCommand::kRelease:
      return refusalOfRelease(session);
    case ConsoleCommand::kApproach:
      return session.injection == InjectionState::kHold ? refusalOfStep(session, InjectionState::kHold, false)
                                                        : refusalOfApproach(session);
    case ConsoleCommand::kIndent:
      return refusalOfStep(session, InjectionState::kContact, false);
    case ConsoleCommand::kAspirate:
      return refusalOfStep(session, InjectionState::kIndent, false);
    case ConsoleCommand::kInject:
      return refusalOfStep(session, InjectionState::kPunctured, true);
    case ConsoleCommand::kWithdraw:
      return refusalOfWithdraw(session);
    default:
      return session.operating == OperatingState::kDisabled ? "it is disabled" : "";
  }
}

}  // namespace

CommandOffer offer(ConsoleCommand command, const SessionView& session) {
  if (command == ConsoleCommand::kStop) return stopOffer(session);
  CommandOffer result = command == ConsoleCommand::kEnable ? enableOffer(session) : describe(command);
  if (!session.connected()) {
    result.refusal = kNoController;
  } else if (!session.listens) {
    result.refusal = kDeaf;
  } else if (command != ConsoleCommand::kEnable) {
    result.refusal = refusalOf(command, session);
  }
  return result;
}

}  // namespace microinjection
