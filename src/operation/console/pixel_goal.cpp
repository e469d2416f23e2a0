#include "operation/console/pixel_goal.h"

#include <cmath>

namespace microinjection {

std::string refusalOfLeading(const SessionView& session) {
  if (session.operating != OperatingState::kEnabled) return "the controller must be ENABLED: press Enable first";
  const std::string& mode = session.settings.mode;
  return mode.empty() || session.byHand() ? "" : "mode is " + mode + ", must be manual";
}

CommandOffer offer(const PixelGoal& goal, const SessionView& session, bool there) {
  CommandOffer result{"Go", "", "", ""};
  if (goal.pixel) {
    result.effect = "brings the tip to (" + std::to_string(std::lround(goal.pixel->x())) + ", " +
                    std::to_string(std::lround(goal.pixel->y())) + ") px";
  }
  if (!there) {
    result.refusal = "no node visual_servo: start the session with camera:=";
  } else if (goal.under_way) {
    result.refusal = "the needle is on its way";
  } else if (!goal.pixel) {
    result.refusal = "click where the tip shall go";
  } else {
    result.refusal = refusalOfLeading(session);
  }
  return result;
}

}  // namespace microinjection
