#include "teleoperation/engagement.h"

namespace microinjection {

EngagementConfig EngagementConfig::read(ConfigReader reader) {
  EngagementConfig config;
  reader.choice("mode", config.alignment, {"index", "agree"});
  reader.number("tolerance", config.tolerance, Range::positive());
  reader.number("speed", config.speed, Range::positive());
  return config;
}

Engagement::State Engagement::step(const Input& input) {
  why_.clear();
  if (input.clutch) anchored_ = false;
  if (input.held) return state_ = State::kHeld;
  if (state_ == State::kFollow) return state_;
  state_ = State::kAlign;
  if (input.speed > config_.speed) {
    why_ = "the hand is fast";
  } else if (!input.let_go) {
    why_ = "the hand would set a speed: let go of the device first";
  } else if (anchored_ && config_.alignment == "agree" && input.disagreement > config_.tolerance) {
    why_ = "the hand is not where it left the needle: go back there, or press and release the clutch";
  } else {
    state_ = State::kFollow;
    anchored_ = true;
  }
  return state_;
}

std::string Engagement::name(State state) {
  if (state == State::kHeld) return "held";
  return state == State::kAlign ? "align" : "follow";
}

}  // namespace microinjection
