#include "operation/console/hand_lines.h"

#include "operation/console/figures.h"

namespace microinjection {

Lamp followsLamp(const HandView& hand) {
  if (!hand.hold_reason) return {hand.has_bridge ? Light::kRed : Light::kGrey, "haptic_bridge is silent"};
  if (hand.hold_reason->empty()) return {Light::kGreen, "the needle follows"};
  return {Light::kYellow, "held: " + *hand.hold_reason};
}

Lamp clutchLamp(const HandView& hand) {
  if (!hand.clutch) return {Light::kGrey, "none"};
  return *hand.clutch ? Lamp{Light::kYellow, "pressed: the hand is free"} : Lamp{Light::kGreen, "released"};
}

Lamp presentLamp(const HandView& hand) {
  if (!hand.present) return {Light::kGrey, "none"};
  return *hand.present ? Lamp{Light::kGreen, "held"} : Lamp{Light::kYellow, "released: the needle is held"};
}

std::string positionScaleText(const HandSettings& settings) {
  if (!settings.error.empty()) return settings.error;
  if (settings.mode == "rate") {
    if (!settings.rate_gain) return "-";
    return "10 mm of the hand: " + micro(10e-3 * *settings.rate_gain, 1) + " um/s";
  }
  return settings.position_scale ? "1 mm of the hand: " + micro(1e-3 * *settings.position_scale, 2) + " um" : "-";
}

std::string forceScaleText(const HandSettings& settings) {
  if (!settings.force_gain) return "-";
  const std::string source = settings.force_source.empty() ? "" : ", " + settings.force_source;
  return "1 uN at the tip: " + figure(1e-6 * *settings.force_gain, 1, 2) + " N" + source;
}

}  // namespace microinjection
