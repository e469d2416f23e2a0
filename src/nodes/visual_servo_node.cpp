#include "nodes/visual_servo_node.h"

#include <limits>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

constexpr double kApproachPeriod = 0.005;  // s: the controller takes a target of 0.05 s ago for stale
constexpr double kProposalForgotten = 60;  // s, after a click
constexpr double kProposalPeriod = 0.2;    // s

}  // namespace

const char* const VisualServoNode::kHelp =
    "visual_servo: brings the needle's tip to a pixel of the microscope's image.\n"
    "In: vision/state, /needle/measured_cp, /controller/operating_state, visual_servo/proposed_pixel.\n"
    "Out: /teleop/servo_cp, visual_servo/proposed_point; action visual_servo/go_to_pixel.\n";

VisualServoNode::Parameters VisualServoNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("calibration", parameters.calibration);
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  parameters.approach = ImageApproachConfig::read(reader);
  reader.finish();
  return parameters;
}

VisualServoNode::VisualServoNode(Bus& bus)
    : GoalNode(bus, "visual_servo/go_to_pixel", "approach", kApproachPeriod),
      parameters_(Parameters::read(bus)),
      watch_(bus, parameters_.input_timeout),
      setpoints_(bus, watch_),
      proposed_point_(bus.advertise<geometry_msgs::PointStamped>("visual_servo/proposed_point", 1, true)),
      proposed_pixel_(subscribeGuarded(bus, "visual_servo/proposed_pixel", 1, &VisualServoNode::onProposal, this)) {}

CameraCalibration VisualServoNode::readFor(const Eigen::Vector2i& image) const {
  const std::string path = calibrationPath(parameters_.calibration);
  const CameraCalibration calibration = readCalibration(path);
  if (const std::string reason = calibration.refusalOf(image); !reason.empty()) throw ConfigError(path + ": " + reason);
  return calibration;
}

void VisualServoNode::onProposal(const geometry_msgs::PointStamped& message) {
  proposal_.reset();
  const Eigen::Vector2d pixel(message.point.x, message.point.y);
  if (!message.header.stamp.isZero() && pixel.allFinite())
    proposal_ = {pixel, bus_.steady(), readFor(watch_.imageSize())};
}

std::optional<Eigen::Vector3d> VisualServoNode::proposedPoint() const {
  const std::optional<Eigen::Vector3d> position = watch_.position();
  if (!proposal_ || !position) return std::nullopt;
  const CameraCalibration& calibration = proposal_->calibration;
  const Eigen::Vector3d place = calibration.placeFor(proposal_->pixel, position->y());
  // As for the way itself, the image says where the tip is now: it may have moved on its holder.
  const std::optional<SeenTip> tip = watch_.tip();
  return tip ? *position + place - calibration.placeFor(tip->pixel, position->y()) : place;
}

void VisualServoNode::publishProposal() {
  const ros::SteadyTime now = bus_.steady();
  if (proposal_ && secondsBetween(proposal_->received, now) > kProposalForgotten) proposal_.reset();
  const std::optional<Eigen::Vector3d> place = proposedPoint();
  if (!place && !proposal_published_) return;
  if (place && secondsBetween(proposal_published_at_, now) < kProposalPeriod) return;
  geometry_msgs::PointStamped point;
  point.header.frame_id = kWorldFrame;
  if (place) point.header.stamp = bus_.now();
  if (place) point.point = toMessage<geometry_msgs::Point>(*place);
  proposed_point_.publish(point);
  proposal_published_ = place.has_value();
  proposal_published_at_ = now;
}

void VisualServoNode::begin(const Goal& goal) {
  start_ = setpoints_.requireStart();
  pixel_ = {goal.x, goal.y};
  if (!watch_.tip()) throw ConfigError("the tip is not seen: " + watch_.tipReason());
  if (const std::string reason = watch_.cellOnTheWay(pixel_); !reason.empty()) throw ConfigError(reason);
  calibration_ = readFor(watch_.imageSize());
  setpoints_.begin(start_);
}

void VisualServoNode::step() {
  publishProposal();
  if (!isActive()) return;
  if (const std::string reason = setpoints_.interruption(); !reason.empty()) return finish(false, reason);
  if (const std::string reason = watch_.cellInTheWay(); !reason.empty()) return finish(false, reason);
  if (const std::string reason = watch_.cellOnTheWay(pixel_); !reason.empty()) return finish(false, reason);
  const double now = bus_.now().toSec();
  if (!approach_) {
    if (!setpoints_.engage()) return;
    approach_ = std::make_unique<ImageApproach>(parameters_.approach, calibration_, pixel_, start_, now);
  }
  const auto setpoint = approach_->step({now, watch_.position(), watch_.restedSince(), watch_.tip()});
  if (setpoint) setpoints_.publish(*setpoint);
  Feedback feedback;
  feedback.distance = approach_->distance();
  feedback.waits_for = approach_->waitsFor();
  publishFeedback(feedback);
  if (approach_->done()) return finish(true, "arrived");
  if (!approach_->failure().empty()) finish(false, approach_->failure());
}

VisualServoNode::Result VisualServoNode::end(bool) {
  Result result;
  result.distance = approach_ ? approach_->distance() : std::numeric_limits<double>::quiet_NaN();
  approach_.reset();
  setpoints_.end();
  return result;
}

void VisualServoNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, isActive() ? "moves the needle" : "waits for a goal");
  bus_.refusals().report(status);
  if (approach_) status.add("distance (px)", approach_->distance());
  if (approach_) status.add("waits for", approach_->waitsFor());
}

}  // namespace microinjection
