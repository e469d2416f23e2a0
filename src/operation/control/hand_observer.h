#pragma once

#include <optional>

#include "operation/control/injection_goal.h"
#include "operation/control/injection_state.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {

/// Names what a hand does with the needle: it sees, and moves nothing.
class HandObserver {
 public:
  /// After a step in `state`; the monitor has seen its force and needle. `injector` empty: nothing valid is known.
  std::optional<InjectionEvent> step(InjectionState state, const NeedleMonitor& monitor,
                                     const std::optional<InjectorReport>& injector);

 private:
  InjectionState state_ = InjectionState::kIdle;
  double deepest_ = 0, shallowest_ = 0;  ///< m past the touch, since the state was entered
};

}  // namespace microinjection
