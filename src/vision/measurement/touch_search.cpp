#include "vision/measurement/touch_search.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kLongest = 0.05;    // s, that the set-point advances in a step: a stall must not become a jump
constexpr double kArrived = 0.1e-6;  // m, of the needle from its set-point
constexpr double kAside = 1e-6;      // m, across the approach: the needle left its line

}  // namespace

TouchSearchConfig TouchSearchConfig::read(ConfigReader& reader) {
  TouchSearchConfig config;
  reader.number("step", config.step, Range{0, 5e-6, true, false});
  reader.number("speed", config.speed, Range{0, 100e-6, true, false});
  reader.number("largest_travel", config.largest_travel, Range{0, 500e-6, true, false});
  reader.number("largest_force", config.largest_force, Range::positive());
  reader.number("settle_time", config.settle_time, Range::closed(0, 10));
  reader.number("image_time", config.image_time, Range::positive());
  reader.number("move_time", config.move_time, Range::positive());
  ConfigReader curve = reader.section("curve");
  config.touch = TouchByVisionConfig::read(curve);
  return config;
}

TouchSearch::TouchSearch(const TouchSearchConfig& config, const Eigen::Vector3d& start,
                         const Eigen::Vector3d& direction, const Input& input)
    : config_(config),
      start_(start),
      direction_(direction),
      force_at_start_(input.force),
      stepped_(input.now),
      since_(input.now) {
  if (!start.allFinite() || !direction.allFinite()) failure_ = "the needle's pose is not finite";
}

std::optional<Eigen::Vector3d> TouchSearch::step(const Input& input) {
  if (done() || !failure_.empty()) return std::nullopt;
  const double duration = std::clamp(input.now - stepped_, 0.0, kLongest);
  stepped_ = input.now;
  watch(input);
  if (!failure_.empty()) return std::nullopt;
  travel_ = std::min(goal_, travel_ + config_.speed * duration);
  waits_for_.clear();
  const Eigen::Vector3d setpoint = start_ + travel_ * direction_;
  if (travel_ < goal_) return setpoint;
  const double elapsed = input.now - since_;
  if ((*input.position - setpoint).norm() > kArrived) {
    waits_for_ = "the needle does not follow";
    if (elapsed > config_.move_time + config_.step / config_.speed) failure_ = waits_for_;
  } else if (const double rested = std::max(input.rested_since, since_) + config_.settle_time;
             input.sight && input.sight->stamp > rested && input.sight->stamp <= input.now) {
    take(*input.sight, input.now);
  } else {
    waits_for_ = input.blind.empty() ? "a fresh image" : input.blind;
    if (elapsed > config_.move_time + config_.image_time) failure_ = "no fresh image of the dimple: " + waits_for_;
  }
  return failure_.empty() && !done() ? std::optional(setpoint) : std::nullopt;
}

/// What must hold at all times.
void TouchSearch::watch(const Input& input) {
  if (!input.position || !input.position->allFinite()) {
    failure_ = "the needle's position is not known";
    return;
  }
  const Eigen::Vector3d away = *input.position - start_;
  if ((away - away.dot(direction_) * direction_).norm() > kAside)
    failure_ = "the needle has left the line of the approach";
  if (!force_at_start_) return;
  if (!input.force || !std::isfinite(*input.force)) {
    failure_ = "the force is not known any more";
    return;
  }
  force_ = *input.force - *force_at_start_;
  if (*force_ <= config_.largest_force) return;
  std::ostringstream text;
  text << "the force is " << 1e6 * *force_ << " uN, allowed " << 1e6 * config_.largest_force << " uN";
  failure_ = text.str();
}

void TouchSearch::take(const Sight& sight, double now) {
  if (!std::isfinite(sight.dimple)) {
    failure_ = "the dimple's depth is not finite";
    return;
  }
  dimple_ = sight.dimple;
  samples_.push_back({travel_, {sight.dimple, 0}});
  report_ = findTouch(samples_, config_.touch);
  if (done()) return;
  goal_ = travel_ + config_.step;
  since_ = now;
  if (goal_ <= config_.largest_travel) return;
  std::ostringstream text;
  text << "no touch within " << 1e6 * config_.largest_travel << " um: " << report_.text;
  failure_ = text.str();
}

}  // namespace microinjection
