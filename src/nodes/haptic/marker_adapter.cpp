#include "nodes/haptic/marker_adapter.h"

#include <ros/console.h>
#include <visualization_msgs/InteractiveMarker.h>

#include <cmath>
#include <cstdio>

#include "nodes/display/display_markers.h"
#include "nodes/runtime/conversions.h"
#include "operation/display/force_arrow.h"

namespace microinjection {
namespace {

/// The handle's name among the interactive markers of /hand_marker.
constexpr char kHandMarker[] = "hand";

using visualization_msgs::InteractiveMarkerControl;

constexpr double kSize = 0.3;  // display units, of the arrows
constexpr double kBall = 0.1;  // display units, diameter

/// A control moves along the x axis of its orientation; rviz draws the arrows.
InteractiveMarkerControl axisControl(const std::string& name, double x, double y, double z) {
  InteractiveMarkerControl control;
  control.name = name;
  control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
  control.orientation.w = std::sqrt(0.5);
  control.orientation.x = std::sqrt(0.5) * x;
  control.orientation.y = std::sqrt(0.5) * y;
  control.orientation.z = std::sqrt(0.5) * z;
  return control;
}

InteractiveMarkerControl ballControl() {
  visualization_msgs::Marker ball;
  ball.type = visualization_msgs::Marker::SPHERE;
  ball.pose.orientation.w = 1;
  ball.scale.x = ball.scale.y = ball.scale.z = kBall;
  ball.color.r = 1.0F;
  ball.color.g = 0.75F;
  ball.color.b = 0.2F;
  ball.color.a = 0.9F;
  InteractiveMarkerControl control;
  control.name = "ball";
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.orientation.w = 1;
  control.always_visible = true;
  control.markers.push_back(ball);
  return control;
}

/// A ball for dragging in the view's plane and an arrow along each axis, in display units around
/// the origin of `frame`.
visualization_msgs::InteractiveMarker handMarker(const std::string& frame) {
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = frame;
  marker.name = kHandMarker;
  marker.scale = static_cast<float>(kSize);
  marker.pose.orientation.w = 1;
  marker.controls = {axisControl("x", 1, 0, 0), axisControl("y", 0, 0, 1), axisControl("z", 0, 1, 0), ballControl()};
  return marker;
}

constexpr char kFrame[] = "viz/world";
constexpr double kDragTimeout = 0.2;            // s, of needle and its target
constexpr double kLongStart = 1.5;              // s, from drag to control; includes a network's round trip
constexpr double kLongHold = 0.5;               // s
constexpr double kShowPeriod = 1.0 / 15;        // s
constexpr double kLeastMotion = 5e-4;           // display units, smallest motion of the needle that moves the handle
constexpr double kTextHeight = 0.04;            // display units
const Eigen::Vector3d kTextOffset{0, 0, 0.22};  // display units, of the text from the handle

/// Titles of the menu's entries, and the commands.
const std::vector<std::pair<std::string, std::string>>& menu() {
  static const std::vector<std::pair<std::string, std::string>> all{
      {"Enable", "enable"},        {"Hold the cell", "hold"},       {"Inject", "inject"},
      {"Withdraw (home)", "home"}, {"Release the cell", "release"}, {"Disable", "disable"}};
  return all;
}

/// An entry's id is its number in menu(), from 1 on.
visualization_msgs::InteractiveMarker markerWithMenu() {
  visualization_msgs::InteractiveMarker marker = handMarker(kFrame);
  for (const auto& [title, command] : menu()) {
    visualization_msgs::MenuEntry entry;
    entry.id = static_cast<std::uint32_t>(marker.menu_entries.size() + 1);
    entry.title = title;
    entry.command_type = visualization_msgs::MenuEntry::FEEDBACK;
    marker.menu_entries.push_back(entry);
  }
  return marker;
}

geometry_msgs::Pose toPoseInDisplay(const Eigen::Vector3d& position, double enlargement) {
  return toPose(toDisplay(position, enlargement), ros::Time(), kFrame).pose;
}

}  // namespace

MarkerConfig MarkerConfig::read(ConfigReader& reader) {
  MarkerConfig config;
  config.hand = GoalHandConfig::read(reader);
  reader.number("hand_scale", config.hand_scale, Range::positive());
  reader.number("enlargement", config.enlargement, Range::positive());
  reader.vector("handle_offset", config.handle_offset, Range::closed(-0.01, 0.01));
  reader.number("arrow_scale", config.arrow_scale, Range::positive());
  return config;
}

MarkerAdapter::MarkerAdapter(Cycle& cycle, const MarkerConfig& config)
    : config_(config),
      hand_(config.hand),
      session_(cycle),
      needle_(cycle.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled, kDragTimeout)),
      target_(cycle.input<geometry_msgs::PoseStamped>("teleop/servo_cp", InputPhase::kSampled, kDragTimeout)),
      server_(cycle.bus(), "hand_marker", markerWithMenu(), [this](const Feedback& feedback) { onFeedback(feedback); }),
      force_(cycle.bus().advertise<visualization_msgs::MarkerArray>("hand_marker/force", 1, true)) {
  controller_ = subscribeGuarded<cell_microinjection::OperatingState>(
      cycle.bus(), "controller/operating_state", 10,
      [this](const cell_microinjection::OperatingState& message, const std::string&) {
        const bool homes = message.state == "ENABLED" && message.is_busy;
        controller_state_ = homes ? "homing" : message.state == "ENABLED" ? "" : message.state;
      });
}

void MarkerAdapter::onFeedback(const Feedback& feedback) {
  const auto event = feedback.event_type;
  if (event == Feedback::MENU_SELECT && feedback.menu_entry_id >= 1 && feedback.menu_entry_id <= menu().size())
    commands_.push_back(menu()[feedback.menu_entry_id - 1].second);
  if (event == Feedback::MOUSE_UP) return endDrag();
  if (event != Feedback::MOUSE_DOWN && event != Feedback::POSE_UPDATE && event != Feedback::KEEP_ALIVE) return;
  const Eigen::Vector3d to = fromDisplay(toVector(feedback.pose.position), config_.enlargement);
  if (feedback.header.frame_id != kFrame || !to.allFinite() || to.norm() > kLargestNeedleDistance) {
    ROS_WARN_THROTTLE(5, "the handle cannot be dragged in frame '%s': set rviz's fixed frame to %s",
                      feedback.header.frame_id.c_str(), kFrame);
    return endDrag();
  }
  handle_ = to;  // also after a lost drag, to move the handle back
  if (event == Feedback::MOUSE_DOWN) beginDrag();
  if (dragged_) hand_.stay();
}

void MarkerAdapter::beginDrag() {
  if (dragged_) return;
  lost_reason_ = tip_ ? "" : "the needle's position is unknown";
  if (!tip_) return;
  dragged_ = true;
  was_controlling_ = false;
  held_ = 0;
  drag_from_ = handle_;
  hand_from_ = hand_.position();
}

void MarkerAdapter::endDrag() {
  dragged_ = false;
  hand_.release();
}

void MarkerAdapter::moveHand(const Cycle::Tick& tick) {
  if (!dragged_) return;
  const bool controls = controller_state_.empty() && target_.get(tick.now);
  held_ = controls ? 0 : held_ + tick.dt;
  was_controlling_ = was_controlling_ || controls;
  const bool long_held = held_ > (was_controlling_ ? kLongHold : kLongStart);
  if (long_held || !hand_.present()) {
    lost_reason_ = !hand_.present()             ? "rviz was silent"
                   : !controller_state_.empty() ? "the controller is " + controller_state_
                   : !session_.held().empty()   ? session_.held()
                                                : "the needle was held";
    return endDrag();
  }
  hand_.moveTo(controls ? hand_from_ + config_.hand_scale * (handle_ - drag_from_) : hand_.position());
}

std::optional<HandReading> MarkerAdapter::read(const Cycle::Tick& tick) {
  const auto needle = validPose(needle_.get(tick.now));
  tip_ = needle ? std::optional<Eigen::Vector3d>(needle->translation()) : std::nullopt;
  moveHand(tick);
  HandReading reading;
  reading.position = hand_.step(tick.dt);
  reading.stamp = tick.now;
  reading.operator_present = hand_.present();
  return reading;
}

void MarkerAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick& tick) {
  if (!isDue(shown_, tick.now, kShowPeriod)) return;
  shown_ = tick.now;
  followNeedle();
  displayForce(force);
}

void MarkerAdapter::followNeedle() {
  if (dragged_) return server_.applyChanges();  // the server has the position from one rviz and publishes it to others
  if (!tip_) return;
  const Eigen::Vector3d position = *tip_ + config_.handle_offset;
  if (config_.enlargement * (position - handle_).norm() < kLeastMotion) return;
  handle_ = position;
  server_.setPose(toPoseInDisplay(handle_, config_.enlargement));
  server_.applyChanges();
}

std::string MarkerAdapter::reasonText() const {
  std::string all;
  if (dragged_ && !session_.held().empty()) all += "\n" + session_.held();
  if (!lost_reason_.empty()) all += "\n" + lost_reason_ + ": release, and drag again";
  if (!controller_state_.empty()) all += "\n" + controller_state_ + " (right button: Enable)";
  if (!session_.notice().empty()) all += "\n" + session_.notice();
  return all;
}

void MarkerAdapter::displayForce(const Eigen::Vector3d& force) {
  const auto arrow = forceArrow(handle_, force, config_.arrow_scale, config_.enlargement);
  const MarkerName arrow_name{kFrame, "force on the hand", 0}, text_name{kFrame, "words", 0};
  const Colour orange{1.0F, 0.45F, 0.1F, 1.0F}, white{1.0F, 1.0F, 1.0F, 1.0F};
  char felt[48];
  std::snprintf(felt, sizeof felt, "%.2f N at the hand", force.norm());
  visualization_msgs::MarkerArray shown;
  shown.markers = {arrow ? arrowMarker(arrow_name, *arrow, orange) : noMarker(arrow_name),
                   textMarker(text_name, toDisplay(handle_, config_.enlargement) + kTextOffset, felt + reasonText(),
                              kTextHeight, white)};
  force_.publish(shown);
}

}  // namespace microinjection
