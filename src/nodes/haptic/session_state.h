#pragma once

#include <string>
#include <vector>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/LoopState.h"
#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/cycle.h"

namespace microinjection {

/// State of the session for the display beside a hand without a device: the controller's state, the
/// injection's state, and why the needle does not follow. For people, not for control.
class SessionState {
 public:
  explicit SessionState(Cycle& cycle);

  /// For example "ENABLED, indent, 0.52 uN, 12.3 um deep" or "no controller".
  std::string text() const;
  /// For example "needle held: clutch is pressed"; empty while the needle follows the hand. A rig
  /// behind a network, then the bridge, then the controller gives the reason.
  std::string held() const;
  /// Why the operator's last command was not executed; else empty.
  const std::string& notice() const { return notice_; }

 private:
  Subscription controller_, injection_;
  std::vector<Subscription> loop_states_;
  std::string state_ = "no controller";
  std::string injection_text_;
  std::string notice_;
  std::string rig_, bridge_, controller_reason_;  ///< why they hold; empty: they follow
};

}  // namespace microinjection
