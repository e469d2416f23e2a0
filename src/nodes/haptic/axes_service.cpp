#include "nodes/haptic/axes_service.h"

#include <cell_microinjection/OperatingState.h>

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/errors.h"
#include "base/operating_state.h"
#include "base/paths.h"
#include "nodes/runtime/background_writing.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kDegree = M_PI / 180;

std::string residualOf(const DeviceAxesFit& fit) {
  char text[160];
  std::snprintf(text, sizeof text, "motions within %.1f degrees of the axes, within %.1f degrees of a right angle",
                fit.angleToAxis() / kDegree, fit.angleToSquare() / kDegree);
  return text;
}

/// The file is written as a whole: one with other keys is the user's own.
std::string ownFile(const std::string& path) {
  if (!std::ifstream(path)) return path;
  bool own = false;
  try {
    const YAML::Node root = YAML::LoadFile(path), bridge = root.IsMap() ? root["haptic_bridge"] : YAML::Node();
    own = root.size() == 1 && bridge && bridge.IsMap() && bridge.size() == 1 && bridge["device_axes"];
  } catch (const YAML::Exception&) {
    own = false;
  }
  if (!own)
    throw ConfigError("axes_file = " + path + ": has other keys than haptic_bridge/device_axes; name another file");
  return path;
}

}  // namespace

AxesService::AxesService(Cycle& cycle, const std::string& axes, bool springs_back, const std::string& file)
    : calibration_(axes, springs_back),
      file_(ownFile(file.empty() ? userDataFile("device_axes.yaml") : file), writingOn(cycle.bus())) {
  using State = cell_microinjection::OperatingState;
  controller_ =
      subscribeGuarded<State>(cycle.bus(), "controller/operating_state", 10,
                              [this](const State& message, const std::string&) { controller_state_ = message.state; });
  server_ = cycle.bus().advertiseService<Service>(
      "~calibrate_axes",
      [this](Service::Request& request, Service::Response& response) { return answer(request, response); });
}

void AxesService::observe(const std::optional<Eigen::Vector3d>& hand, bool followed) {
  hand_ = hand;
  followed_ = followed;
}

std::string AxesService::holdReason() const {
  return calibration_.running() ? "the axes of the haptic device are being calibrated" : "";
}

std::string AxesService::followsReason() const {
  const bool may_move = controller_state_.empty() || controller_state_ == toText(OperatingState::kEnabled);
  return followed_ && may_move ? "the needle follows the hand: release the operator's button, press the clutch or "
                                 "disable the controller"
                               : "";
}

std::string AxesService::act(int action) {
  const std::string follows = followsReason();
  switch (action) {
    case Service::Request::BEGIN:
      return follows.empty() ? calibration_.begin(hand_) : follows;
    case Service::Request::MOTION:
      return calibration_.motion(hand_);
    case Service::Request::UNDO:
      return calibration_.running() || follows.empty() ? calibration_.undo(hand_) : follows;
    case Service::Request::STOP:
      calibration_.stop();
      return "";
    default:
      return "action must be BEGIN, MOTION, UNDO or STOP";
  }
}

bool AxesService::answer(Service::Request& request, Service::Response& response) {
  const std::string refusal = act(request.action);
  response.success = refusal.empty();
  response.message = refusal.empty() ? calibration_.prompt() : refusal;
  response.next = calibration_.running() ? calibration_.fit().next() : "";
  response.device_axes = calibration_.axes();
  response.angle_to_axis = calibration_.fit().angleToAxis();
  response.angle_to_square = calibration_.fit().angleToSquare();
  response.file = file_.path();
  write();
  return true;
}

void AxesService::write() {
  if (kept_changes_ == calibration_.changes()) return;
  kept_changes_ = calibration_.changes();
  const DeviceAxesFit& fit = calibration_.fit();
  file_.write(
      "# Axes of the haptic device, by the service calibrate_axes of the node haptic_bridge. A session takes\n"
      "# them with set:=overrides=FILE.\nhaptic_bridge:\n  device_axes: " +
      calibration_.axes() + (fit.complete() ? "  # " + residualOf(fit) : "") + "\n");
}

void AxesService::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string unwritten = file_.error();
  status.add("device axes", calibration_.axes());
  if (calibration_.fit().complete()) status.add("calibration of the axes", residualOf(calibration_.fit()));
  if (calibration_.changes() > 0) status.add("file of the axes", unwritten.empty() ? file_.path() : unwritten);
}

}  // namespace microinjection
