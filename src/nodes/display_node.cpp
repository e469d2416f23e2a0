#include "nodes/display_node.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "nodes/display/cell_state_reader.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kFixedPeriod = 1;  // s of steady time; a late rviz has the whole scene by then
constexpr double kStaleAge = 1;     // s of steady time

CellMembers toMembers(const cell_microinjection::CellState& message) {
  CellMembers members;
  for (const auto& p : message.member_points) members.points.push_back(toVector(p));
  members.forces.assign(message.member_force.begin(), message.member_force.end());
  members.kinds.assign(message.member_kind.begin(), message.member_kind.end());
  return members;
}

CellIdentity toIdentity(const cell_microinjection::CellState& message) {
  return {message.parameter_names, message.parameter_values, message.layer_radii, message.material};
}

/// CRTK: a message with stamp 0 withdraws the last one.
template <typename Message>
bool isValid(const Message& message) {
  return !message.header.stamp.isZero();
}

std::string describe(const cell_microinjection::CellState& message) {
  if (message.punctured && message.converged) return message.inside ? "INSIDE" : "PUNCTURED";
  if (!message.converged) return "no solution: " + message.reason;
  return message.in_contact ? "in contact" : "no contact";
}

/// The needle's axis is world's z until its pose is known.
std::optional<ForceParts> partsOnTip(const std::optional<Eigen::Vector3d>& force,
                                     const std::optional<Eigen::Isometry3d>& tip) {
  if (!force) return std::nullopt;
  return partsOf(*force, tip.value_or(Eigen::Isometry3d::Identity()).linear().col(2));
}

/// Depths in order, of a cell that can be.
bool isDrawable(const cell_microinjection::PuncturePrediction& puncture) {
  constexpr double kDeepest = 0.01;  // m
  return 0 <= puncture.depth_low && puncture.depth_low <= puncture.depth && puncture.depth <= puncture.depth_high &&
         0 < puncture.depth_high && puncture.depth_high < kDeepest && std::abs(puncture.force) < kLargestForce;
}

DisplayConfig readConfig(const Bus& bus) {
  ConfigReader reader = parameterReader(bus);
  const DisplayConfig config = DisplayConfig::read(reader);
  reader.finish();
  return config;
}

}  // namespace

const char* const DisplayNode::kHelp =
    "display: shows the scene in rviz, ten thousand times enlarged.\n"
    "In: /cell/state /force_sensor/measured_cf /haptic/measured_cp /controller/injection_state /cell/estimate\n"
    "/visual_servo/proposed_point,\n"
    "tf of world, cell, needle_tip and the rig.\n"
    "Also viz/set_view (DisplayView).\n"
    "Out: viz/markers viz/still (MarkerArray), viz/view, tf below viz/world.\n";

DisplayNode::DisplayNode(Bus& bus)
    : bus_(bus),
      config_(readConfig(bus)),
      scene_(config_),
      frames_(bus, {"cell", "holding_pipette", "manipulator_base"}, config_.enlargement),
      trail_(config_.trail),
      inputs_{{{"/cell/state", true},
               {"/force_sensor/measured_cf", true},
               {"/haptic/measured_cp", false},
               {"/controller/injection_state", false},
               {"/cell/estimate", false},
               {"/visual_servo/proposed_point", false}}},
      reported_(bus.steady()),
      diagnostics_(bus) {
  state_.readout.state = "waiting for the cell";
  markers_ = bus.advertise<visualization_msgs::MarkerArray>("viz/markers", 5);
  fixed_markers_ = bus.advertise<visualization_msgs::MarkerArray>("viz/still", 1, true);
  view_ = bus.advertise<cell_microinjection::DisplayView>("viz/view", 1, true);
  state_.colour = *surfaceQuantity(config_.colour);
  state_.section = config_.section;
  publishView();
  subscriptions_.push_back(subscribeGuarded(bus, "viz/set_view", 1, &DisplayNode::onView, this));
  subscribe(kState, &DisplayNode::onState);
  subscribe(kMeasured, &DisplayNode::onMeasuredForce);
  subscribe(kHand, &DisplayNode::onHand);
  subscribe(kInjection, &DisplayNode::onInjection);
  subscribe(kEstimate, &DisplayNode::onEstimate);
  subscribe(kProposed, &DisplayNode::onProposed);
  diagnostics_.add("drawing", this, &DisplayNode::reportDrawing);
  diagnostics_.add("inputs", this, &DisplayNode::reportInputs);
  timer_ = bus.timer(1 / config_.rate, [this] { draw(); });
}

template <typename Message>
void DisplayNode::subscribe(InputId input, void (DisplayNode::*handler)(const Message&)) {
  constexpr int kQueue = 1;  // only the latest message is drawn
  subscriptions_.push_back(subscribeGuarded(bus_, inputs_[input].topic, kQueue, handler, this));
}

void DisplayNode::count(InputId input, bool drawn) {
  inputs_[input].received = bus_.steady();
  if (!drawn) ++inputs_[input].refused;
}

void DisplayNode::onState(const cell_microinjection::CellState& message) {
  CellSurface surface = toSurface(message);
  CellMembers members = toMembers(message);
  const std::string defect = surface.defect() + members.defect();
  count(kState, defect.empty());
  state_.readout.state = defect.empty() ? describe(message) : "not drawn: " + defect;
  state_.alarm = !defect.empty() || message.punctured || !message.converged;
  state_.readout.indentation = std::nullopt;
  if (std::isfinite(message.indentation)) state_.readout.indentation = message.indentation;
  const Eigen::Vector3d force = toVector(message.force);
  state_.predicted = std::nullopt;
  if (message.converged && isWithin(force, kLargestForce)) state_.predicted = force;
  state_.readout.predicted = partsOnTip(state_.predicted, state_.tip);
  if (!defect.empty()) return;
  state_.cell_frame = message.header.frame_id.empty() ? "cell" : message.header.frame_id;
  state_.cell = toIdentity(message);
  state_.surface = std::move(surface);
  state_.members = std::move(members);
  state_.solid = toSolid(message);
  state_.borders = toBorders(message);
  state_.holes.clear();
  for (const auto& hole : message.holes) state_.holes.push_back(toVector(hole));
  cell_changed_ = true;
}

void DisplayNode::onView(const cell_microinjection::DisplayView& message) {
  if (!message.colour.empty()) {
    const auto colour = surfaceQuantity(message.colour);
    if (!colour) throw std::runtime_error("there is no colour \"" + message.colour.substr(0, 40) + "\"");
    state_.colour = *colour;
  }
  state_.section = message.section != 0;
  cell_changed_ = true;
  publishView();
}

void DisplayNode::publishView() {
  cell_microinjection::DisplayView view;
  view.colour = surfaceQuantities()[static_cast<std::size_t>(state_.colour)];
  view.section = state_.section;
  view_.publish(view);
}

void DisplayNode::findTipTransform() {
  const bool was_valid = state_.tip.has_value();
  state_.tip = frames_.find("world", "needle_tip");
  if (state_.tip.has_value() != was_valid) fixed_drawn_ = {};  // shows or hides the pipette at once
}

void DisplayNode::onHand(const geometry_msgs::PoseStamped& message) {
  state_.readout.hand = isValid(message) ? validPosition(&message, message.header.frame_id) : std::nullopt;
  count(kHand, state_.readout.hand.has_value());
}

void DisplayNode::onProposed(const geometry_msgs::PointStamped& message) {
  const Eigen::Vector3d place = toVector(message.point);
  state_.proposed = std::nullopt;
  if (isValid(message) && message.header.frame_id == "world" && place.allFinite()) state_.proposed = place;
  count(kProposed, message.header.stamp.isZero() || state_.proposed.has_value());
}

void DisplayNode::onInjection(const cell_microinjection::InjectionStatus& message) {
  state_.readout.injection = message.state + (message.waits ? ", waits" : "");
  count(kInjection, true);
}

void DisplayNode::onEstimate(const cell_microinjection::CellEstimate& message) {
  const auto& puncture = message.puncture;
  const bool none = puncture.depth == 0;
  const bool drawn = isValid(message) && (none || isDrawable(puncture));
  state_.readout.puncture = std::nullopt;
  if (drawn && !none) {
    state_.readout.puncture = {puncture.depth, puncture.depth_low, puncture.depth_high, puncture.force,
                               puncture.beyond >= 0.5};
  }
  count(kEstimate, drawn);
}

void DisplayNode::onMeasuredForce(const geometry_msgs::WrenchStamped& message) {
  const Eigen::Isometry3d tip = state_.tip.value_or(Eigen::Isometry3d::Identity());
  state_.measured = isValid(message) ? validForce(&message, tip.linear()) : std::nullopt;
  state_.readout.measured = partsOnTip(state_.measured, state_.tip);
  count(kMeasured, state_.measured.has_value());
}

void DisplayNode::draw() {
  const ros::SteadyTime start = bus_.steady();
  frames_.update();
  findTipTransform();
  if (secondsBetween(inputs_[kEstimate].received, start) > kStaleAge) state_.readout.puncture = std::nullopt;
  if (secondsBetween(inputs_[kProposed].received, start) > kStaleAge) state_.proposed = std::nullopt;
  if (state_.tip) {
    frames_.publishNeedleTip(*state_.tip);
    if (config_.trail > 0) trail_.add(start.toSec(), state_.tip->translation());
  }
  if (markers_.subscribers() > 0) {
    visualization_msgs::MarkerArray markers;
    if (state_.section) state_.tip_in_cell = frames_.find(state_.cell_frame, "needle_tip");
    if (cell_changed_) scene_.drawCell(state_, markers);
    cell_changed_ = false;
    state_.trail = trail_.lines(config_.enlargement);
    scene_.drawMoving(state_, markers);
    markers_.publish(markers);
  }
  if (fixed_markers_.subscribers() > 0 &&
      (scene_.fixedChanged() || fixed_drawn_.isZero() || secondsBetween(fixed_drawn_, start) > kFixedPeriod)) {
    state_.holding_from_cell = frames_.find("holding_pipette", state_.cell_frame);
    visualization_msgs::MarkerArray markers;
    scene_.drawFixed(state_, markers);
    fixed_markers_.publish(markers);
    fixed_drawn_ = start;
  }
  ++drawings_;
  longest_drawing_ = std::max(longest_drawing_, secondsBetween(start, bus_.steady()));
  diagnostics_.update();
}

void DisplayNode::reportDrawing(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = bus_.steady();
  const double rate = drawings_ / std::max(1e-9, secondsBetween(reported_, now));
  const std::vector<std::string> missing = frames_.missing();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "drawing");
  if (rate < 0.5 * config_.rate) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "slow");
  for (const std::string& frame : missing) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "tf has no transform world -> " + frame);
  }
  status.add("rate (Hz of wall time)", rate);
  status.add("rate wanted (Hz)", config_.rate);
  if (!scene_.colourReason().empty()) status.add("colour is the displacement's, because", scene_.colourReason());
  status.add("longest drawing (ms)", 1e3 * longest_drawing_);
  reported_ = now;
  drawings_ = 0;
  longest_drawing_ = 0;
}

void DisplayNode::reportInputs(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = bus_.steady();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "inputs are fresh");
  for (const Input& input : inputs_) {
    const bool silent = input.received.isZero();
    const double age = silent ? 0 : secondsBetween(input.received, now);
    if (input.needed && (silent || age > kStaleAge)) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, input.topic + (silent ? " is silent" : " is stale"));
    }
    if (input.refused > 0) {
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN,
                          input.topic + ": some were not finite, invalid or in an unknown frame");
    }
    status.add(input.topic + " age (s of wall time)", silent ? std::string("never received") : std::to_string(age));
    status.add(input.topic + " messages not drawn", input.refused);
  }
}

}  // namespace microinjection
