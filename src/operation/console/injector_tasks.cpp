#include "operation/console/injector_tasks.h"

namespace microinjection {

CommandOffer offer(InjectorTask task, const InjectorTasksView& view) {
  const bool is_reset = task == InjectorTask::kReset;
  CommandOffer result = is_reset ? CommandOffer{"Reset", "", "clears fault and volume", ""}
                                 : CommandOffer{"Set", "", "the pressure between pulses", ""};
  if (!view.injector) {
    result.refusal = "injector is silent";
  } else if (!is_reset) {
    if (!view.listens) result.refusal = "injector does not receive commands yet";
  } else if (view.called) {
    result.refusal = "the injector is asked";
  } else if (view.injector->busy) {
    result.refusal = "no reset during a pulse";
  }
  return result;
}

std::string injectorTasksText(const InjectorTasksView& view) {
  if (!view.refusal.empty()) return view.refusal;
  for (const InjectorTask task : kInjectorTasks) {
    const std::string refusal = offer(task, view).refusal;
    if (!refusal.empty()) return refusal;
  }
  const CommandOffer reset = offer(InjectorTask::kReset, view);
  return reset.label + " " + reset.effect;
}

}  // namespace microinjection
