#pragma once

#include <optional>

#include "operation/control/injection_goal.h"
#include "operation/control/injection_state.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {

/// Recognises the events of an injection by hand. It only observes.
class HandObserver {
 public:
  /// Call after a step in `state`, when the monitor has its force and needle. `injector` empty: no
  /// valid report.
  std::optional<InjectionEvent> step(InjectionState state, const NeedleMonitor& monitor,
                                     const std::optional<InjectorReport>& injector);

 private:
  InjectionState state_ = InjectionState::kIdle;
  double deepest_ = 0, shallowest_ = 0;  ///< m past the contact point, in this state
};

}  // namespace microinjection
