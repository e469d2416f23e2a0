#include "operation/teleoperation/engagement.h"

namespace microinjection {

EngagementConfig EngagementConfig::read(ConfigReader reader) {
  EngagementConfig config;
  reader.choice("mode", config.mode, {"index", "agree"});
  reader.number("tolerance", config.tolerance, Range::positive());
  reader.number("speed", config.speed, Range::positive());
  reader.number("speed_limit", config.speed_limit, Range::positive());
  reader.number("speed_time", config.speed_time, Range::nonNegative());
  reader.number("rest_time", config.rest_time, Range::nonNegative());
  reader.number("interruption", config.interruption, Range::nonNegative());
  return config;
}

/// Counts from the second fast sample: the first may be a late one that covers an unknown time.
bool Engagement::tooFast(const Input& input) {
  if (input.speed <= config_.speed_limit) {
    fast_time_.reset();
  } else {
    fast_time_ = fast_time_ ? *fast_time_ + input.dt : 0;
  }
  return fast_time_ && *fast_time_ >= config_.speed_time - 1e-9;
}

Engagement::State Engagement::step(const Input& input) {
  reason_.clear();
  if (input.clutch) has_reference_ = false;
  const bool followed = state_ == State::kFollow;
  const bool lost = followed && (tooFast(input) || input.leaps);
  if (lost) rest_time_left_ = config_.rest_time;
  if (input.held) {
    if (followed) held_time_ = 0;
    held_time_ += input.interrupted ? input.dt : std::numeric_limits<double>::infinity();
    return state_ = State::kHeld;
  }
  if (followed && !lost) return state_;
  const bool continues = state_ == State::kHeld && held_time_ <= config_.interruption && rest_time_left_ == 0;
  held_time_ = std::numeric_limits<double>::infinity();
  state_ = State::kAlign;
  fast_time_.reset();
  const bool fast = input.speed > (continues ? config_.speed_limit : config_.speed);
  if (rest_time_left_ > 0) rest_time_left_ = fast ? config_.rest_time : std::max(0.0, rest_time_left_ - input.dt);
  if (fast) {
    reason_ = "the hand is fast";
  } else if (rest_time_left_ > 0) {
    reason_ = "the hand was too fast to be one that holds the device: rest";
  } else if (!input.released) {
    reason_ = "the hand would set a speed: let go of the device first";
  } else if (has_reference_ && config_.mode == "agree" && input.misalignment > config_.tolerance) {
    reason_ = "the hand is not where it left the needle: go back there, or press and release the clutch";
  } else {
    state_ = State::kFollow;
    has_reference_ = true;
  }
  return state_;
}

std::string Engagement::name(State state) {
  if (state == State::kHeld) return "held";
  return state == State::kAlign ? "align" : "follow";
}

}  // namespace microinjection
