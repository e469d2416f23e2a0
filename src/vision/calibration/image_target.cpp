#include "vision/calibration/image_target.h"

#include <cmath>
#include <sstream>

#include "base/vectors.h"

namespace microinjection {

ImageTargetConfig ImageTargetConfig::read(ConfigReader& reader) {
  ImageTargetConfig config;
  reader.number("gain", config.gain, Range{0, 1, true, false});
  reader.number("largest_step", config.largest_step, Range::positive());
  reader.number("largest_age", config.largest_age, Range::positive());
  reader.number("tolerance", config.tolerance, Range::positive());
  reader.number("largest_jump", config.largest_jump, Range::positive());
  return config;
}

std::string ImageTarget::refusalOf(const TipFrame& frame, const Play& play, double now, double rested_since) const {
  std::ostringstream text;
  if (!std::isfinite(frame.stamp) || !std::isfinite(now) || !std::isfinite(rested_since)) {
    return "a time is not finite";
  }
  if (!frame.tip.allFinite()) return "the tip's pixel is not finite";
  if (last_ && frame.sequence <= last_->sequence) {
    text << "image " << frame.sequence << " is not newer than image " << last_->sequence;
  } else if (last_ && frame.stamp <= last_->stamp) {
    text << "image " << frame.sequence << " is out of order: exposed at " << frame.stamp << " s, the one before at "
         << last_->stamp << " s";
  } else if (frame.stamp > now) {
    text << "the image is of the future: exposed " << frame.stamp - now << " s from now";
  } else if (now - frame.stamp > config_.largest_age) {
    text << "the image is stale: age " << now - frame.stamp << " s, allowed up to " << config_.largest_age << " s";
  } else if (frame.stamp < rested_since) {
    text << "the image was exposed " << rested_since - frame.stamp << " s before the needle came to rest";
  } else if (!play.known(0) || !play.known(2)) {
    text << "axis " << (play.known(0) ? 'z' : 'x')
         << ": its play is not known, move it by more than its backlash first";
  }
  return text.str();
}

ImageStep ImageTarget::step(const TipFrame& frame, const Eigen::Vector2d& target, const CameraCalibration& calibration,
                            const Play& play, double now, double rested_since) {
  ImageStep step;
  step.reason = refusalOf(frame, play, now, rested_since);
  if (step.reason.empty() && !target.allFinite()) step.reason = "the target's pixel is not finite";
  if (!step.reason.empty()) return step;
  last_ = frame;
  const Eigen::Vector3d place = play.tip();
  const Eigen::Vector3d seen = calibration.placeFor(frame.tip, place.y());
  // A detector that took something else for the tip must not lead the needle.
  if ((seen - place).norm() > config_.largest_jump) {
    std::ostringstream text;
    text << "the tip is seen " << 1e6 * (seen - place).norm() << " um from where it is expected, allowed up to "
         << 1e6 * config_.largest_jump << " um";
    step.reason = text.str();
    return step;
  }
  if ((target - frame.tip).norm() <= config_.tolerance) {
    step.arrived = true;
    step.reason = "arrived";
    return step;
  }
  const Eigen::Vector3d error = calibration.placeFor(target, place.y()) - seen;
  const Eigen::Vector3d goal = place + clampedNorm(config_.gain * error, config_.largest_step);
  step.position = play.commandFor(goal).back();
  return step;
}

}  // namespace microinjection
