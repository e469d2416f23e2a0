#include "nodes/microscope_node.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "nodes/cell/cell_state_reader.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {

const char* const MicroscopeNode::kHelp =
    "microscope: the virtual microscope. Renders the session as its camera sees it.\n"
    "In: /cell/state, /needle/measured_cp or /needle/true_cp, tf of cell and holding_pipette, /focus/move_jp "
    "(JointState:\n"
    "the plane in focus, m).\n"
    "Out: microscope/image_raw microscope/camera_info /focus/measured_js.\n";

MicroscopeNode::Parameters MicroscopeNode::readParameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
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

MicroscopeNode::MicroscopeNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(readParameters(private_node)),
      microscope_(parameters_.microscope),
      focus_(parameters_.focus),
      frames_(node),
      images_(node),
      stepped_(ros::SteadyTime::now()),
      reported_(stepped_),
      focus_state_(node.advertise<sensor_msgs::JointState>("/focus/measured_js", 1)),
      diagnostics_(node, private_node) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
  constexpr int kQueue = 1;
  state_ = subscribeGuarded<cell_microinjection::CellState>(
      node, "/cell/state", kQueue,
      [this](const cell_microinjection::CellState& message, const std::string&) { onState(message); });
  needle_ = subscribeGuarded<geometry_msgs::PoseStamped>(
      node, parameters_.needle == "true" ? "/needle/true_cp" : "/needle/measured_cp", kQueue,
      [this](const geometry_msgs::PoseStamped& message, const std::string&) { onNeedle(message); });
  focus_command_ = subscribeGuarded<sensor_msgs::JointState>(
      node, "/focus/move_jp", kQueue,
      [this](const sensor_msgs::JointState& message, const std::string&) { onFocus(message); }, StampRule::kCommand);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("images", this, &MicroscopeNode::report);
  timer_ =
      node.createSteadyTimer(ros::WallDuration(1 / parameters_.rate), [this](const ros::SteadyTimerEvent&) { step(); });
}

void MicroscopeNode::run() { ros::spin(); }

void MicroscopeNode::onState(const cell_microinjection::CellState& message) {
  CellSurface surface = toSurface(message);
  defect_ = surface.defect();
  if (!defect_.empty()) {
    MessageRefusals::ofProcess().add("/cell/state", defect_);
    return;
  }
  cell_frame_ = message.header.frame_id.empty() ? "cell" : message.header.frame_id;
  specimen_.vertices = std::move(surface.vertices);
  specimen_.triangles = std::move(surface.triangles);
  specimen_.radius = 0.5 * cellParameter(message, "diameter").value_or(0);
  specimen_.shell_thickness = cellParameter(message, "shell_thickness").value_or(0);
  received_ = ros::SteadyTime::now();
}

void MicroscopeNode::onNeedle(const geometry_msgs::PoseStamped& message) {
  specimen_.needle = validPose(&message);
  needle_arrival_ = Arrival(message.header.stamp);
}

bool MicroscopeNode::needleIsFresh() const {
  return specimen_.needle && !needle_arrival_.isOld(parameters_.state_timeout);
}

void MicroscopeNode::onFocus(const sensor_msgs::JointState& message) {
  const Eigen::Vector2d& range = parameters_.focus.range;
  if (message.position.size() != 1 || !focus_.allows(message.position[0])) {
    MessageRefusals::ofProcess().add("/focus/move_jp", "position must be one number from " + std::to_string(range.x()) +
                                                           " to " + std::to_string(range.y()) + " m");
    return;
  }
  focus_.moveTo(message.position[0]);
}

std::string MicroscopeNode::missingInput() const {
  if (!defect_.empty()) return "/cell/state: " + defect_;
  if (received_.isZero()) return "/cell/state is silent";
  if (secondsBetween(received_, ros::SteadyTime::now()) > parameters_.state_timeout) return "/cell/state is stale";
  if (!frames_.find("world", cell_frame_)) return "tf has no transform world -> " + cell_frame_;
  return "";
}

void MicroscopeNode::step() {
  const ros::SteadyTime start = ros::SteadyTime::now();
  focus_.step(std::max(0.0, secondsBetween(stepped_, start)));
  stepped_ = start;
  const ros::Time now = ros::Time::now();
  publishFocus(now);
  if (images_.wanted() && missingInput().empty()) {
    Specimen specimen = specimen_;
    if (!needleIsFresh()) specimen.needle.reset();
    const Eigen::Isometry3d cell = *frames_.find("world", cell_frame_);
    for (Eigen::Vector3d& vertex : specimen.vertices) vertex = cell * vertex;
    specimen.holder = frames_.find("world", "holding_pipette");
    runGuarded("microscope/image_raw", [&] {
      const MicroscopeScene scene = specimenScene(parameters_.specimen, specimen);
      images_.publish(microscope_.render(scene, focus_.position(), ++frame_), now);
      ++rendered_;
    });
    longest_render_ = std::max(longest_render_, secondsBetween(start, ros::SteadyTime::now()));
  }
  endIfOrphaned(master_);
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
  const ros::SteadyTime now = ros::SteadyTime::now();
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
  MessageRefusals::ofProcess().report(status);
  status.add("rate (Hz)", rate);
  status.add("rate wanted (Hz)", parameters_.rate);
  status.add("longest image (ms)", 1e3 * longest_render_);
  status.add("focus (m)", focus_.position());
  reported_ = now;
  rendered_ = 0;
  longest_render_ = 0;
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::MicroscopeNode>(argc, argv, "microscope",
                                                                 microinjection::Priority::kOrdinary);
}
