#include "operation/teleoperation/device_axes_calibration.h"

#include "base/vectors.h"

namespace microinjection {
namespace {

constexpr char kNoHand[] = "no valid hand position";

}  // namespace

std::string DeviceAxesCalibration::begin(const Hand& hand) {
  if (!isValid(hand)) return kNoHand;
  fit_ = DeviceAxesFit();
  start_ = *hand;
  running_ = true;
  return "";
}

std::string DeviceAxesCalibration::motion(const Hand& hand) {
  if (!running_) return "no calibration is running: begin one";
  if (!isValid(hand)) return kNoHand;
  const std::string refusal = fit_.add(*hand - start_);
  // A refused motion is repeated from where the hand is now.
  if (!springs_back_) start_ = *hand;
  if (!refusal.empty()) return refusal;
  if (!fit_.complete()) return "";
  running_ = false;
  earlier_.push_back(axes_);
  axes_ = fit_.axes();
  ++changes_;
  return "";
}

std::string DeviceAxesCalibration::undo(const Hand& hand) {
  if (running_ && fit_.motions() == 0) {
    running_ = false;
    return "";
  }
  if (running_) {
    if (!isValid(hand)) return kNoHand;
    fit_.removeLast();
    if (!springs_back_) start_ = *hand;
    return "";
  }
  if (earlier_.empty()) return "nothing to take back in this session";
  axes_ = earlier_.back();
  earlier_.pop_back();
  fit_ = DeviceAxesFit();
  ++changes_;
  return "";
}

std::string DeviceAxesCalibration::prompt() const {
  if (!running_) return "device_axes: " + axes_;
  const std::string way = fit_.next() == "right" ? "to the right" : fit_.next();
  return "move the hand " + way + ", as the image shows it, by 10 mm or more" +
         (springs_back_ ? " from its rest, and keep it there" : "");
}

}  // namespace microinjection
