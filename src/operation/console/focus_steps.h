#pragma once

#include <limits>
#include <optional>

#include "operation/console/console_commands.h"

namespace microinjection {

/// What the console knows of the focus, m: the place that its motor reports.
struct FocusView {
  std::optional<double> position;  ///< empty: no motor reports, or it has fallen silent
  std::optional<double> goal;      ///< of the last step, while the motor may be on its way
  bool searched = false;           ///< the action /focus/find moves it
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
};

/// Where a step (m, positive or negative) leads. Steps add up: the next one need not wait for the motor.
double focusGoal(const FocusView& focus, double step);

/// What the button of such a step does now. It needs a position.
CommandOffer offerFocusStep(const FocusView& focus, double step);

}  // namespace microinjection
