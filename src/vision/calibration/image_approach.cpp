#include "vision/calibration/image_approach.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kLongest = 0.05;     // s, that the set-point advances in a step: a stall must not become a jump
constexpr double kAtGoal = 0.5e-6;    // m, of the motors from their goal
constexpr double kBeyondPlay = 3e-6;  // m, by which a motion is longer than the backlash that it takes up

}  // namespace

ImageApproachConfig ImageApproachConfig::read(ConfigReader& reader) {
  ImageApproachConfig config;
  reader.number("speed", config.speed, Range::positive());
  reader.number("settle_time", config.settle_time, Range::nonNegative());
  reader.number("time_limit", config.time_limit, Range::positive());
  ConfigReader target = reader.section("image_target");
  config.target = ImageTargetConfig::read(target);
  return config;
}

ImageApproach::ImageApproach(const ImageApproachConfig& config, const CameraCalibration& calibration,
                             const Eigen::Vector2d& target, const Eigen::Vector3d& position, double now)
    : config_(config),
      calibration_(calibration),
      pixel_(target),
      images_(config.target),
      play_(calibration.backlash(), position),
      stream_(position, kAtGoal, now),
      setpoint_(position),
      goal_(position),
      began_(now),
      stepped_(now),
      distance_(std::numeric_limits<double>::quiet_NaN()) {
  if (!target.allFinite()) failure_ = "the target's pixel is not finite";
}

std::optional<Eigen::Vector3d> ImageApproach::step(const Input& input) {
  if (done_ || !failure_.empty()) return std::nullopt;
  const double duration = std::clamp(input.now - stepped_, 0.0, kLongest);
  stepped_ = input.now;
  if (input.now - began_ > config_.time_limit) {
    std::ostringstream text;
    text << "the tip has not arrived within " << config_.time_limit << " s";
    if (!waits_for_.empty()) text << ": " << waits_for_;
    failure_ = text.str();
    return std::nullopt;
  }
  if (!input.position) {
    waits_for_ = "the needle's position is not known";
    return setpoint_;
  }
  setpoint_ = stream_.advance(goal_, config_.speed * duration);
  waits_for_.clear();
  if (stream_.arrived(*input.position, input.now)) {
    if (input.now - input.rested_since >= config_.settle_time) plan(input);
  } else if (stream_.waits()) {
    waits_for_ = "the needle does not follow";
  }
  return done_ ? std::nullopt : std::optional(setpoint_);
}

void ImageApproach::plan(const Input& input) {
  play_.moveTo(goal_);
  if (taken_up_ < 2) {
    const int axis = taken_up_ == 0 ? 2 : 0;
    goal_[axis] += play_.backlash()[axis] + kBeyondPlay;
    ++taken_up_;
    return;
  }
  if (!input.tip) {
    waits_for_ = "the tip is not seen";
    return;
  }
  if (input.tip->stamp == last_stamp_) {
    waits_for_ = refusal_;
    return;
  }
  last_stamp_ = input.tip->stamp;
  const TipFrame frame{++sequence_, input.tip->stamp, input.tip->pixel};
  const ImageStep next =
      images_.step(frame, pixel_, calibration_, play_, input.now, input.rested_since + config_.settle_time);
  distance_ = (input.tip->pixel - pixel_).norm();
  done_ = next.arrived;
  if (next.position) goal_ = *next.position;
  refusal_ = next.position || done_ ? "" : next.reason;
  waits_for_ = refusal_;
}

}  // namespace microinjection
