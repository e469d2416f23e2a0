#include "nodes/haptic/session_state.h"

#include <cstdio>

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
  using cell_microinjection::OperatingState;
  using diagnostic_msgs::DiagnosticArray;
  controller_ = subscribeGuarded<OperatingState>(
      cycle.node(), "controller/operating_state", 10,
      [this](const OperatingState& message, const std::string&) { state_ = message.state; });
  injection_ = subscribeGuarded<InjectionStatus>(cycle.node(), "controller/injection_state", 1,
                                                 [this](const InjectionStatus& message, const std::string&) {
                                                   injection_text_ = describe(message);
                                                   notice_ = message.notice;
                                                 });
  diagnostics_ = subscribeGuarded<DiagnosticArray>(
      cycle.node(), "/diagnostics", 10,
      [this](const DiagnosticArray& message, const std::string&) { process(message); });
}

std::string SessionState::text() const { return state_ + injection_text_; }

std::string SessionState::held() const {
  // Only the follower reports why it holds, unless the bridge itself is the reason.
  return held_.empty() || follower_.empty() || follower_.find("the hand's side") != std::string::npos ? held_
                                                                                                      : follower_;
}

void SessionState::process(const diagnostic_msgs::DiagnosticArray& diagnostics) {
  for (const auto& status : diagnostics.status) {
    if (status.name == "haptic_bridge: loop") held_ = status.level == 0 ? "" : status.message;
    if (status.name == "teleoperation_follower: link") follower_ = status.level == 0 ? "" : status.message;
    if (status.name == "injection_controller: control" && status.level != 0 && held_.empty()) held_ = status.message;
  }
}

}  // namespace microinjection
