// The injector's pulse: when it is wanted, and what ends it.

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
  if (status == InjectorWait::Status::kTimeOut) notice_ = "the injector does not say that the pulse is over";
  apply(InjectionEvent::kInjected);
}

/// Where it is not known what is injected into. By hand only the pulse is over.
void InjectionController::endPulse(const std::string& why) {
  if (!pulse()) return;
  if (byHand()) {
    notice_ = "the pulse was ended: " + why;
    return apply(InjectionEvent::kInjected);
  }
  stop(InjectionOutcome::kGuard, why + " while it injects");
}

}  // namespace microinjection
