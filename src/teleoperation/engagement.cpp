#include "teleoperation/engagement.h"

#include <limits>

namespace microinjection {

EngagementConfig EngagementConfig::read(ConfigReader reader) {
  EngagementConfig config;
  reader.choice("mode", config.alignment, {"index", "agree"});
  reader.number("tolerance", config.tolerance, Range::positive());
  reader.number("speed", config.speed, Range::positive());
  reader.number("interruption", config.interruption, Range::nonNegative());
  return config;
}

Engagement::State Engagement::step(const Input& input) {
  why_.clear();
  if (input.clutch) anchored_ = false;
  if (input.held) {
    if (state_ == State::kFollow) held_time_ = 0;
    held_time_ += input.interrupted ? input.dt : std::numeric_limits<double>::infinity();
    return state_ = State::kHeld;
  }
  if (state_ == State::kFollow) return state_;
  const bool goes_on = state_ == State::kHeld && held_time_ <= config_.interruption;
  held_time_ = std::numeric_limits<double>::infinity();
  state_ = State::kAlign;
  if (input.speed > config_.speed && !goes_on) {
    why_ = "the hand is fast";
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
