#include "operation/console/needle_steps.h"

#include "operation/console/figures.h"

namespace microinjection {

Eigen::Vector3d needleGoal(const NeedleView& needle, const Eigen::Vector3d& step) {
  return needle.goal.value_or(needle.tip.value_or(Eigen::Vector3d::Zero())) + step;
}

CommandOffer offerNeedleStep(const NeedleView& needle, const SessionView& session) {
  CommandOffer result;
  const bool led = session.operating && session.operating != OperatingState::kDisabled;
  if (!needle.state) {
    result.refusal = "no node micromanipulator";
  } else if (led) {
    result.refusal = std::string(toText(*session.operating)) + ": press Disable first";
  } else if (session.listens && !session.operating) {
    result.refusal = "the controller is silent";
  } else if (needle.calibrating) {
    result.refusal = "the calibration moves the needle";
  } else if (needle.state != OperatingState::kEnabled) {
    result.refusal = std::string("the micromanipulator is ") + toText(*needle.state);
  } else if (needle.busy && !needle.goal) {
    result.refusal = "the needle is on its way";
  } else if (!needle.tip) {
    result.refusal = "the needle's position is not known";
  } else {
    const Eigen::Vector3d& at = *needle.tip;
    result.effect = "at " + micro(at.x(), 1) + ", " + micro(at.y(), 1) + ", " + micro(at.z(), 1) + " um";
  }
  return result;
}

}  // namespace microinjection
