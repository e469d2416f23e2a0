#include "operation/console/focus_steps.h"

#include "operation/console/figures.h"

namespace microinjection {

double focusGoal(const FocusView& focus, double step) { return focus.goal.value_or(focus.position.value_or(0)) + step; }

CommandOffer offerFocusStep(const FocusView& focus, double step) {
  CommandOffer result;
  result.label = step < 0 ? "-" : "+";
  if (!focus.position) {
    result.refusal = "/focus/measured_js is silent";
    return result;
  }
  result.effect = "at " + micro(*focus.position, 1) + " um";
  const double goal = focusGoal(focus, step);
  if (focus.searched) {
    result.refusal = result.effect + ", the focus is searched";
  } else if (goal > focus.highest) {
    result.refusal = result.effect + ", its range ends at " + micro(focus.highest, 1) + " um";
  } else if (goal < focus.lowest) {
    result.refusal = result.effect + ", its range ends at " + micro(focus.lowest, 1) + " um";
  }
  return result;
}

}  // namespace microinjection
