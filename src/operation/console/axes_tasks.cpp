#include "operation/console/axes_tasks.h"

#include <cmath>
#include <cstdio>

namespace microinjection {
namespace {

CommandOffer describe(AxesTask task, const std::string& next) {
  switch (task) {
    case AxesTask::kStep:
      return {"Axes", "", next.empty() ? "begins; then right, away, up" : "move the hand " + next + ", press", ""};
    case AxesTask::kUndo:
      return {"Undo", "", next.empty() ? "the axes before" : "takes back the last motion", ""};
    case AxesTask::kEnd:
      break;
  }
  return {"End", "", "ends it without a change", ""};
}

std::string residual(const AxesView& axes) {
  if (axes.angle_to_axis == 0 && axes.angle_to_square == 0) return "";
  char text[80];
  std::snprintf(text, sizeof text, "; off axis %.1f, off square %.1f degrees", axes.angle_to_axis * 180 / M_PI,
                axes.angle_to_square * 180 / M_PI);
  return text;
}

}  // namespace

CommandOffer offer(AxesTask task, const AxesView& axes) {
  CommandOffer result = describe(task, axes.next);
  if (!axes.there) {
    result.refusal = "no node haptic_bridge";
  } else if (axes.called) {
    result.refusal = "the bridge is asked";
  } else if (task == AxesTask::kEnd && axes.next.empty()) {
    result.refusal = "nothing to end";
  }
  return result;
}

Lamp axesLamp(const AxesView& axes) {
  if (!axes.refusal.empty()) return {Light::kRed, axes.refusal};
  if (!axes.there || !axes.answered) return {Light::kGrey, "not calibrated by this console"};
  if (!axes.next.empty()) return {Light::kYellow, "needle held; next: " + axes.next + residual(axes)};
  return {Light::kGreen, "axes " + axes.axes + residual(axes)};
}

}  // namespace microinjection
