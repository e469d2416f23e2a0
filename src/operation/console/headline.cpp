#include "operation/console/headline.h"

#include <algorithm>
#include <array>
#include <string>

namespace microinjection {
namespace {

/// The controller's reasons to hold the needle that are no alarm: nobody moves it, or it moves by itself.
constexpr std::array<const char*, 3> kCalm = {"no valid target", "no injection is under way", "homing"};

/// The needle is held although the controller is ENABLED: by a guard, or for want of an input.
bool heldByAlarm(const SessionView& session) {
  const std::string& reason = session.hold_reason;
  const auto same = [&reason](const char* calm) { return reason == calm; };
  return !reason.empty() && std::none_of(kCalm.begin(), kCalm.end(), same);
}

std::string nextSteps(const SessionView& session) {
  switch (*session.injection) {
    case InjectionState::kHold:
      return "the cell is held; waits for Approach or Withdraw";
    case InjectionState::kRelease:
      return "waits for Release";
    case InjectionState::kContact:
      return "waits for Indent or Withdraw";
    case InjectionState::kIndent:
      return session.settings.has_suction ? "waits for Aspirate or Withdraw" : "waits for Withdraw";
    case InjectionState::kPunctured:
      return session.volume > 0 ? "waits for Withdraw" : "waits for Inject or Withdraw";
    default:
      return "waits for Withdraw";
  }
}

std::string enabledText(const SessionView& session) {
  if (session.waits) return nextSteps(session);
  if (*session.injection == InjectionState::kIdle && !session.busy) {
    if (session.byHand()) return session.hold_reason.empty() ? "follows the hand" : session.hold_reason;
    const bool holds = session.settings.has_holder && session.settings.holds;
    return holds ? "ready: Hold starts an injection" : "ready: Approach starts an injection";
  }
  if (session.busy) return session.hold_reason.empty() ? "moves by itself" : session.hold_reason;
  return session.hold_reason.empty() ? "follows the hand" : session.hold_reason;
}

Lamp ofController(const SessionView& session) {
  if (!session.connected()) return {Light::kRed, "No message of injection_controller"};
  const std::string state = std::string(toText(*session.operating)) + ": ";
  switch (*session.operating) {
    case OperatingState::kDisabled:
      return {Light::kGrey, state + "Enable lets the controller move the needle"};
    case OperatingState::kFault:
      return {Light::kRed, state + session.hold_reason};
    case OperatingState::kPaused: {
      const bool said = session.hold_reason.empty() || session.hold_reason == toText(OperatingState::kPaused);
      const char* const ways = session.byHand() ? "Resume or Home" : "Resume, Withdraw or Home";
      return {Light::kYellow, state + (said ? std::string("the needle is held; ") + ways : session.hold_reason)};
    }
    case OperatingState::kEnabled:
      break;
  }
  if (!session.settings.error.empty()) return {Light::kYellow, state + session.settings.error};
  if (!session.notice.empty()) return {Light::kYellow, state + session.notice};
  if (heldByAlarm(session)) return {Light::kYellow, state + "held: " + session.hold_reason};
  return {Light::kGreen, state + enabledText(session)};
}

}  // namespace

Lamp headline(const SessionView& session) {
  Lamp lamp = ofController(session);
  if (lamp.light == Light::kGreen || !session.hindrance) return lamp;
  const HindranceView& first = *session.hindrance;
  // The controller may hold the needle for that reason, and has said so.
  if (lamp.text.find(first.reason) == std::string::npos) lamp.text += "; " + first.node + ": " + first.reason;
  if (!first.remedy.empty()) lamp.text += " - " + first.remedy;
  if (lamp.light == Light::kGrey && first.is_error) lamp.light = Light::kYellow;
  return lamp;
}

}  // namespace microinjection
