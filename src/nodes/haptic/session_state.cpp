#include "nodes/haptic/session_state.h"

#include <cstdio>
#include <utility>

namespace microinjection {
namespace {

std::string describe(const cell_microinjection::InjectionStatus& status) {
  char text[120];
  std::snprintf(text, sizeof text, ", %s, %.2f uN, %.1f um deep", status.state.c_str(), 1e6 * status.force,
                1e6 * status.depth);
  std::string all = text;
  if (status.punctures > 0) all += ", through " + std::to_string(status.punctures);
  if (status.volume > 0) {
    std::snprintf(text, sizeof text, ", %.1f pL injected", 1e15 * status.volume);
    all += text;
  }
  if (!status.notice.empty()) all += "; " + status.notice;
  return all;
}

}  // namespace

SessionState::SessionState(Cycle& cycle) {
  using cell_microinjection::InjectionStatus;
  using cell_microinjection::LoopState;
  using cell_microinjection::OperatingState;
  controller_ = subscribeGuarded<OperatingState>(
      cycle.bus(), "controller/operating_state", 10,
      [this](const OperatingState& message, const std::string&) { state_ = message.state; });
  injection_ = subscribeGuarded<InjectionStatus>(cycle.bus(), "controller/injection_state", 1,
                                                 [this](const InjectionStatus& message, const std::string&) {
                                                   injection_text_ = describe(message);
                                                   notice_ = message.notice;
                                                 });
  const std::pair<const char*, std::string*> loops[] = {
      {"link/rig/loop_state", &rig_}, {"haptic/loop_state", &bridge_}, {"controller/loop_state", &controller_reason_}};
  for (const auto& [topic, reason] : loops) {
    loop_states_.push_back(subscribeGuarded<LoopState>(
        cycle.bus(), topic, 1,
        [reason = reason](const LoopState& message, const std::string&) { *reason = message.hold_reason; }));
  }
}

std::string SessionState::text() const { return state_ + injection_text_; }

std::string SessionState::held() const {
  // If the bridge holds, the rig's side only repeats that.
  const bool repeats = rig_.find("the hand's side") != std::string::npos;
  const std::string& reason = bridge_.empty() ? controller_reason_ : rig_.empty() || repeats ? bridge_ : rig_;
  return reason.empty() ? "" : "needle held: " + reason;
}

}  // namespace microinjection
