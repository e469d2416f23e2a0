#include "nodes/microscope_node.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "nodes/display/cell_state_reader.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {

const char* const MicroscopeNode::kHelp =
    "microscope: the virtual microscope. Renders the session as its camera sees it.\n"
    "In: /cell/state, /needle/measured_cp or /needle/true_cp, tf of cell and holding_pipette, /focus/move_jp "
    "(JointState:\n"
    "the plane in focus, m), /cell/bore /cell/hold.\n"
    "Out: microscope/image_raw microscope/camera_info /focus/measured_js.\n";

MicroscopeNode::Parameters MicroscopeNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(1, 120));
  reader.choice("needle", parameters.needle, {"measured", "true"});
  reader.number("state_timeout", parameters.state_timeout, Range::positive());
  ConfigReader focus = reader.section("focus");
  parameters.focus = FocusAxisConfig::read(focus);
  ConfigReader specimen = reader.section("specimen");
  parameters.specimen = SpecimenConfig::read(specimen);
  parameters.microscope = MicroscopeConfig::read(reader);
  reader.finish();
  return parameters;
}

MicroscopeNode::MicroscopeNode(Bus& bus)
    : bus_(bus),
      parameters_(Parameters::read(bus)),
      microscope_(parameters_.microscope),
      focus_(parameters_.focus),
      frames_(bus),
      images_(bus),
      stepped_(bus.steady()),
      reported_(stepped_),
      focus_state_(bus.advertise<sensor_msgs::JointState>("/focus/measured_js", 1)),
      diagnostics_(bus) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
  constexpr int kQueue = 1;
  state_ = subscribeGuarded(bus, "/cell/state", kQueue, &MicroscopeNode::onState, this);
  needle_ = subscribeGuarded(bus, parameters_.needle == "true" ? "/needle/true_cp" : "/needle/measured_cp", kQueue,
                             &MicroscopeNode::onNeedle, this);
  bore_ = subscribeGuarded(bus, "/cell/bore", kQueue, &MicroscopeNode::onBore, this);
  hold_ = subscribeMeasured(bus, "/cell/hold", kQueue, &MicroscopeNode::onHold, this);
  focus_command_ = subscribeGuarded(bus, "/focus/move_jp", kQueue, &MicroscopeNode::onFocus, this, StampRule::kCommand);
  diagnostics_.add("images", this, &MicroscopeNode::report);
  timer_ = bus.timer(1 / parameters_.rate, [this] { step(); });
}

void MicroscopeNode::onState(const cell_microinjection::CellState& message) {
  CellSurface surface = toSurface(message);
  defect_ = surface.defect();
  if (!defect_.empty()) {
    bus_.refusals().add("/cell/state", defect_);
    return;
  }
  cell_frame_ = message.header.frame_id.empty() ? "cell" : message.header.frame_id;
  specimen_.vertices = std::move(surface.vertices);
  specimen_.triangles = std::move(surface.triangles);
  specimen_.radius = 0.5 * cellParameter(message, "diameter").value_or(0);
  specimen_.shell_thickness = cellParameter(message, "shell_thickness").value_or(0);
  punctured_ = message.punctured;
  received_ = bus_.steady();
}

void MicroscopeNode::onNeedle(const geometry_msgs::PoseStamped& message) {
  specimen_.needle = validPose(&message);
  needle_receipt_ = {message.header.stamp, bus_.steady()};
}

void MicroscopeNode::onBore(const cell_microinjection::BoreState& message) {
  if (!std::isfinite(message.length) || message.length < 0) {
    bus_.refusals().add("/cell/bore", "its length is not at or above 0");
    return;
  }
  // Only an intact membrane has a tension.
  const bool whole = !punctured_ || message.tension > 0;
  specimen_.in_needle.reset();
  if (message.length > 0) specimen_.in_needle = Specimen::InNeedle{message.length, !whole};
  bore_receipt_ = {message.header.stamp, bus_.steady()};
}

void MicroscopeNode::onHold(const cell_microinjection::CellHold& message) {
  const auto& q = message.orientation;
  const Eigen::Quaterniond orientation(q.w, q.x, q.y, q.z);
  const Eigen::Vector3d offset = toVector(message.offset);
  if (!offset.allFinite() || !(std::abs(orientation.norm() - 1) < 1e-3) || message.tongue < 0)
    return bus_.refusals().add("/cell/hold", "its pose is none, or its tongue below 0");
  moved_ = Eigen::Translation3d(offset) * orientation;
  specimen_.in_holder = std::isfinite(message.tongue) ? message.tongue : 0;
  hold_receipt_ = {message.header.stamp, bus_.steady()};
}

bool MicroscopeNode::isFresh(const Receipt& receipt) const {
  return !receipt.isOld(parameters_.state_timeout, bus_.now(), bus_.steady());
}

bool MicroscopeNode::needleIsFresh() const { return specimen_.needle && isFresh(needle_receipt_); }

Specimen MicroscopeNode::specimen() const {
  Specimen specimen = specimen_;
  if (!needleIsFresh()) specimen.needle.reset();
  if (!isFresh(bore_receipt_)) specimen.in_needle.reset();
  const bool hold_tells = isFresh(hold_receipt_);
  if (!hold_tells) specimen.in_holder = 0;
  specimen.cell = *frames_.find("world", cell_frame_);
  for (Eigen::Vector3d& vertex : specimen.vertices) vertex = specimen.cell * vertex;
  if (hold_tells) specimen.cell = specimen.cell * moved_;  // the surface is there already
  specimen.holder = frames_.find("world", "holding_pipette");
  return specimen;
}

void MicroscopeNode::onFocus(const sensor_msgs::JointState& message) {
  const Eigen::Vector2d& range = parameters_.focus.range;
  if (message.position.size() != 1 || !focus_.allows(message.position[0])) {
    bus_.refusals().add("/focus/move_jp", "position must be one number from " + std::to_string(range.x()) + " to " +
                                              std::to_string(range.y()) + " m");
    return;
  }
  focus_.moveTo(message.position[0]);
}

std::string MicroscopeNode::missingInput() const {
  if (!defect_.empty()) return "/cell/state: " + defect_;
  if (received_.isZero()) return "/cell/state is silent";
  if (secondsBetween(received_, bus_.steady()) > parameters_.state_timeout) return "/cell/state is stale";
  if (!frames_.find("world", cell_frame_)) return "tf has no transform world -> " + cell_frame_;
  return "";
}

void MicroscopeNode::step() {
  const ros::SteadyTime start = bus_.steady();
  focus_.step(std::max(0.0, secondsBetween(stepped_, start)));
  stepped_ = start;
  const ros::Time now = bus_.now();
  publishFocus(now);
  if (images_.wanted() && missingInput().empty()) {
    runGuarded(bus_.refusals(), "microscope/image_raw", [&] {
      const MicroscopeScene scene = specimenScene(parameters_.specimen, specimen());
      images_.publish(microscope_.render(scene, focus_.position(), ++frame_), now);
      ++rendered_;
    });
    longest_render_ = std::max(longest_render_, secondsBetween(start, bus_.steady()));
  }
  diagnostics_.update();
}

void MicroscopeNode::publishFocus(const ros::Time& now) {
  sensor_msgs::JointState state;
  state.header.stamp = now;
  state.name = {"focus"};
  state.position = {focus_.position()};
  state.velocity = {focus_.moving() ? parameters_.focus.speed : 0};
  focus_state_.publish(state);
}

void MicroscopeNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = bus_.steady();
  const double rate = rendered_ / std::max(1e-9, secondsBetween(reported_, now));
  const std::string missing = missingInput();
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, images_.wanted() ? "rendering" : "nobody reads the images");
  if (images_.wanted() && missing.empty() && rate < 0.5 * parameters_.rate)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "slow");
  if (!missing.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, "no image: " + missing);
  if (!needleIsFresh())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "no needle: its pose is silent, old or invalid");
  if (!frames_.find("world", "holding_pipette"))
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "no holding pipette: tf lacks it");
  bus_.refusals().report(status);
  status.add("rate (Hz)", rate);
  status.add("rate wanted (Hz)", parameters_.rate);
  status.add("longest image (ms)", 1e3 * longest_render_);
  status.add("focus (m)", focus_.position());
  reported_ = now;
  rendered_ = 0;
  longest_render_ = 0;
}

}  // namespace microinjection
