#include "nodes/visual_servo_node.h"

#include <limits>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"
#include "vision/calibration/calibration_file.h"
#include "vision/calibration/calibration_path.h"

namespace microinjection {
namespace {

constexpr double kPatience = 10;   // s, for the controller to connect
constexpr double kEngaging = 0.5;  // s: the controller counts a hand's targets from the first that it has received
constexpr double kPeriod = 0.005;  // s of wall time: the controller takes a target of 0.05 s ago for stale
constexpr double kForgotten = 60;  // s, after a click
constexpr double kProposalPeriod = 0.2;  // s
constexpr char kSetpoints[] = "/teleop/servo_cp";

}  // namespace

const char* const VisualServoNode::kHelp =
    "visual_servo: brings the needle's tip to a pixel of the microscope's image.\n"
    "In: vision/state, /needle/measured_cp, /controller/operating_state, visual_servo/proposed_pixel.\n"
    "Out: /teleop/servo_cp, visual_servo/proposed_point; action visual_servo/go_to_pixel.\n";

VisualServoNode::Parameters VisualServoNode::readParameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("calibration", parameters.calibration);
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  parameters.approach = ImageApproachConfig::read(reader);
  reader.finish();
  return parameters;
}

VisualServoNode::VisualServoNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(readParameters(private_node)),
      node_(node),
      watch_(node, parameters_.input_timeout),
      proposed_point_(node.advertise<geometry_msgs::PointStamped>("visual_servo/proposed_point", 1, true)),
      proposed_pixel_(subscribeGuarded<geometry_msgs::PointStamped>(
          node, "visual_servo/proposed_pixel", 1,
          [this](const geometry_msgs::PointStamped& message, const std::string&) { onProposal(message); })),
      others_(subscribeGuarded<geometry_msgs::PoseStamped>(
          node, kSetpoints, 1, [](const geometry_msgs::PoseStamped&, const std::string&) {})),
      action_(node, "visual_servo/go_to_pixel", false),
      diagnostics_(node, private_node) {
  action_.registerGoalCallback([this] { onGoal(); });
  action_.registerPreemptCallback([this] {
    if (calibration_) finish(false, "cancelled");
  });
  action_.start();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("approach", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, calibration_ ? "moves the needle" : "waits for a goal");
    MessageRefusals::ofProcess().report(status);
    if (approach_) status.add("distance (px)", approach_->distance());
    if (approach_) status.add("waits for", approach_->waitsFor());
  });
  timer_ = node.createSteadyTimer(ros::WallDuration(kPeriod), [this](const ros::SteadyTimerEvent&) { step(); });
}

void VisualServoNode::run() { ros::spin(); }

void VisualServoNode::onProposal(const geometry_msgs::PointStamped& message) {
  proposal_.reset();
  const Eigen::Vector2d pixel(message.point.x, message.point.y);
  if (!message.header.stamp.isZero() && pixel.allFinite())
    proposal_ = {pixel, ros::SteadyTime::now(), readCalibration(calibrationPath(parameters_.calibration))};
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
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (proposal_ && secondsBetween(proposal_->received, now) > kForgotten) proposal_.reset();
  const std::optional<Eigen::Vector3d> place = proposedPoint();
  if (!place && !proposal_published_) return;
  if (place && secondsBetween(proposal_published_at_, now) < kProposalPeriod) return;
  geometry_msgs::PointStamped point;
  point.header.frame_id = kWorldFrame;
  if (place) point.header.stamp = ros::Time::now();
  if (place) point.point = toMessage<geometry_msgs::Point>(*place);
  proposed_point_.publish(point);
  proposal_published_ = place.has_value();
  proposal_published_at_ = now;
}

void VisualServoNode::onGoal() {
  const auto goal = action_.acceptNewGoal();
  try {
    begin({goal->x, goal->y});
  } catch (const std::exception& error) {
    finish(false, error.what());
  }
}

void VisualServoNode::begin(const Eigen::Vector2d& pixel) {
  if (watch_.controller().state != "ENABLED")
    throw ConfigError("the controller is " + watch_.controller().state + ", must be ENABLED");
  if (others_.getNumPublishers() > 0) throw ConfigError(std::string("another node publishes ") + kSetpoints);
  if (const std::string reason = watch_.cellInTheWay(); !reason.empty()) throw ConfigError(reason);
  const std::optional<Eigen::Vector3d> position = watch_.position();
  if (!position) throw ConfigError("/needle/measured_cp is silent or invalid");
  if (!watch_.tip()) throw ConfigError("the tip is not seen: " + watch_.tipReason());
  if (const std::string reason = watch_.cellOnTheWay(pixel); !reason.empty()) throw ConfigError(reason);
  calibration_ = readCalibration(calibrationPath(parameters_.calibration));
  pixel_ = pixel;
  start_ = *position;
  accepted_ = began_ = ros::SteadyTime::now();
  setpoints_ = node_.advertise<geometry_msgs::PoseStamped>(kSetpoints, 1);
}

bool VisualServoNode::isEngaged() {
  // This node's own subscription is one of them.
  if (setpoints_.getNumSubscribers() < 2) began_ = ros::SteadyTime::now();
  return secondsBetween(began_, ros::SteadyTime::now()) > kEngaging;
}

void VisualServoNode::publish(const Eigen::Vector3d& setpoint, const ros::Time& now) {
  setpoints_.publish(toPose(watch_.poseAt(setpoint), now, kWorldFrame));
}

void VisualServoNode::step() {
  diagnostics_.update();
  endIfOrphaned(master_);
  publishProposal();
  if (!calibration_) return;
  if (watch_.controller().state != "ENABLED") return finish(false, "the controller is " + watch_.controller().state);
  if (others_.getNumPublishers() > 1) return finish(false, std::string("another node publishes ") + kSetpoints);
  if (const std::string reason = watch_.cellInTheWay(); !reason.empty()) return finish(false, reason);
  if (const std::string reason = watch_.cellOnTheWay(pixel_); !reason.empty()) return finish(false, reason);
  const ros::Time now = ros::Time::now();
  if (!approach_) {
    publish(start_, now);
    if (secondsBetween(accepted_, ros::SteadyTime::now()) > kPatience)
      return finish(false, "the controller does not follow " + std::string(kSetpoints) + ": its mode must be manual");
    if (!isEngaged()) return;
    approach_ = std::make_unique<ImageApproach>(parameters_.approach, *calibration_, pixel_, start_, now.toSec());
  }
  const auto setpoint = approach_->step({now.toSec(), watch_.position(), watch_.restedSince(), watch_.tip()});
  if (setpoint) publish(*setpoint, now);
  cell_microinjection::GoToPixelFeedback feedback;
  feedback.distance = approach_->distance();
  feedback.waits_for = approach_->waitsFor();
  action_.publishFeedback(feedback);
  if (approach_->done()) return finish(true, "arrived");
  if (!approach_->failure().empty()) finish(false, approach_->failure());
}

void VisualServoNode::finish(bool success, const std::string& message) {
  cell_microinjection::GoToPixelResult result;
  result.success = static_cast<unsigned char>(success);
  result.message = message;
  result.distance = approach_ ? approach_->distance() : std::numeric_limits<double>::quiet_NaN();
  approach_.reset();
  calibration_.reset();
  setpoints_.shutdown();
  if (success) {
    action_.setSucceeded(result, message);
  } else if (action_.isPreemptRequested()) {
    action_.setPreempted(result, message);
  } else {
    action_.setAborted(result, message);
  }
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::VisualServoNode>(argc, argv, "visual_servo",
                                                                  microinjection::Priority::kOrdinary);
}
