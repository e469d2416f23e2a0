#include "nodes/imaging/tip_watch.h"

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kResolution = 0.2e-6;  // m, within which a needle rests

}  // namespace

TipWatch::TipWatch(const ros::NodeHandle& node, double timeout) : timeout_(timeout) {
  constexpr int kQueue = 1;
  using cell_microinjection::OperatingState;
  using cell_microinjection::VisionState;
  subscribers_ = {
      subscribeGuarded<geometry_msgs::PoseStamped>(
          node, "/needle/measured_cp", kQueue,
          [this](const geometry_msgs::PoseStamped& message, const std::string&) { onNeedle(message); }),
      subscribeGuarded<VisionState>(node, "vision/state", kQueue,
                                    [this](const VisionState& message, const std::string&) { onVision(message); }),
      subscribeGuarded<OperatingState>(
          node, "/needle/operating_state", kQueue,
          [this](const OperatingState& message, const std::string&) { needle_state_ = message; }),
      subscribeGuarded<OperatingState>(
          node, "/controller/operating_state", kQueue,
          [this](const OperatingState& message, const std::string&) { controller_state_ = message; })};
}

std::optional<Eigen::Vector3d> TipWatch::position() const {
  if (!position_ || secondsBetween(position_received_, ros::SteadyTime::now()) > timeout_) return std::nullopt;
  return position_;
}

std::optional<SeenTip> TipWatch::tip() const {
  if (!tip_ || secondsBetween(tip_received_, ros::SteadyTime::now()) > timeout_) return std::nullopt;
  return tip_;
}

void TipWatch::onNeedle(const geometry_msgs::PoseStamped& message) {
  const std::optional<Eigen::Isometry3d> pose = validPose(&message);
  position_.reset();
  if (!pose) return;
  position_ = pose->translation();
  orientation_ = Eigen::Quaterniond(pose->linear());
  position_received_ = ros::SteadyTime::now();
  if ((*position_ - resting_place_).norm() <= kResolution) return;
  resting_place_ = *position_;
  rested_ = ros::Time::now().toSec();
  if (on_motion) on_motion(*position_);
}

void TipWatch::onVision(const cell_microinjection::VisionState& message) {
  tip_.reset();
  tip_received_ = ros::SteadyTime::now();
  const auto& tip = message.injection_pipette;
  tip_reason_ = tip.reason;
  image_centre_ = Eigen::Vector2d(message.width - 1.0, message.height - 1.0) / 2;
  if (tip.verdict != tip.FOUND) return;
  SeenTip seen;
  seen.stamp = message.header.stamp.toSec();
  seen.pixel = {tip.x, tip.y};
  for (int i = 0; i < 4; ++i) seen.covariance(i / 2, i % 2) = tip.covariance[i];
  if (!seen.pixel.allFinite() || !seen.covariance.allFinite()) {
    tip_reason_ = "the tip's place is not finite";
    return;
  }
  tip_ = seen;
  if (on_tip) on_tip(seen);
}

}  // namespace microinjection
