// The injector's pulse: when it runs, and what ends it.

#include "operation/control/injection_controller.h"

namespace microinjection {

std::optional<PulseGoal> InjectionController::pulse() const {
  if (injection_ != InjectionState::kInject) return std::nullopt;
  if (run_.active()) return run_.goal().pulse;
  return pulse_by_hand_ ? std::optional(config_.goal.pulse) : std::nullopt;
}

void InjectionController::monitorManualPulse(const Input& input, double dt) {
  if (!pulse_by_hand_) return;
  const InjectorWait::Status status = hand_pulse_.step(input.injector, dt);
  if (status == InjectorWait::Status::kWaiting) return;
  if (status == InjectorWait::Status::kBroken) notice_ = "the injector ended the pulse too early";
  if (status == InjectorWait::Status::kRefused) notice_ = "the injector refused the pulse: " + input.injector->refusal;
  if (status == InjectorWait::Status::kTimeOut) notice_ = "the injector does not report the end of the pulse";
  apply(InjectionEvent::kInjected);
}

/// Ends a pulse whose target is unknown for lack of a valid input. By hand the injection itself
/// continues.
void InjectionController::endPulse(const std::string& reason) {
  if (!pulse()) return;
  if (byHand()) {
    notice_ = "the pulse was ended: " + reason;
    return apply(InjectionEvent::kInjected);
  }
  stop(InjectionOutcome::kGuard, reason + " while it injects");
}

}  // namespace microinjection
