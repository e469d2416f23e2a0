#include "nodes/touch_node.h"

#include <cmath>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kTouchPeriod = 0.005;  // s: the controller takes a target of 0.05 s ago for stale

}  // namespace

const char* const TouchNode::kHelp =
    "touch: lowers the needle until the image shows that it touches the cell.\n"
    "In: vision/state, /needle/measured_cp, /controller/operating_state, /force_sensor/measured_cf.\n"
    "Out: /teleop/servo_cp; action touch/find.\n";

TouchNode::Parameters TouchNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  parameters.search = TouchSearchConfig::read(reader);
  reader.finish();
  return parameters;
}

TouchNode::TouchNode(Bus& bus)
    : GoalNode(bus, "touch/find", "touch", kTouchPeriod),
      parameters_(Parameters::read(bus)),
      watch_(bus, parameters_.input_timeout),
      setpoints_(bus, watch_),
      vision_(subscribeMeasured(bus, "vision/state", 1, &TouchNode::onVision, this)),
      forces_(subscribeMeasured(bus, "/force_sensor/measured_cf", 1, &TouchNode::onForce, this)) {}

void TouchNode::onVision(const cell_microinjection::VisionState& message) {
  observation_.reset();
  const auto& tip = message.injection_pipette;
  const auto& cell = message.cell;
  const auto& beside = message.indentation;
  observation_receipt_ = receive(message.header.stamp);
  image_problem_ = "the image is old, or stamped ahead";
  if (isOld(observation_receipt_, parameters_.input_timeout)) return;
  image_problem_ = "the cell is not found: " + cell.reason;
  if (cell.verdict == cell.NOT_FOUND) return;
  image_problem_ = "the tip is not found: " + tip.reason;
  if (tip.verdict == tip.NOT_FOUND) return;
  image_problem_ = "the outline beside the needle is not clear: " + beside.reason;
  const bool certain = cell.verdict == cell.FOUND && tip.verdict == tip.FOUND;
  const TouchSearch::Observation observation{message.header.stamp.toSec(), beside.displacement,
                                             beside.displacement_deviation, beside.gap, certain};
  if (!std::isfinite(observation.displacement + observation.deviation + observation.gap)) return;
  image_problem_.clear();
  observation_ = observation;
}

/// An invalid reading is as none: force_timeout after the last valid one the search fails.
void TouchNode::onForce(const geometry_msgs::WrenchStamped& message) {
  const Receipt receipt = receive(message.header.stamp);
  const std::optional<Eigen::Vector3d> force = finiteForce(&message);
  if (message.header.stamp.isZero() || isOld(receipt, parameters_.force_timeout) || !force) return;
  force_ = force->z();
  force_stamp_ = message.header.stamp.toSec();
  force_receipt_ = receipt;
}

TouchSearch::Input TouchNode::input() const {
  TouchSearch::Input input{
      bus_.now().toSec(), watch_.position(), watch_.restedSince(), observation_, image_problem_, force_, force_stamp_};
  if (isOld(observation_receipt_, parameters_.input_timeout)) input.observation.reset();
  if (isOld(force_receipt_, parameters_.force_timeout)) input.force.reset();
  return input;
}

void TouchNode::begin(const Goal& goal) {
  const double most = parameters_.search.largest_travel;
  if (!Range::closed(0, most).contains(goal.travel))
    throw ConfigError("travel = " + std::to_string(goal.travel) + " m: must be from 0 to " + std::to_string(most) +
                      " m");
  start_ = setpoints_.requireStart();
  const auto observation = input().observation;
  if (!observation)
    throw ConfigError("the image does not show the touch: " +
                      (image_problem_.empty() ? "the image is old" : image_problem_));
  if (forces_.publishers() > 0 && !input().force)
    throw ConfigError("/force_sensor/measured_cf is silent or invalid: the force could not be watched");
  if (!observation->certain) throw ConfigError("the cell or the tip is uncertain in the image");
  travel_ = goal.travel > 0 ? goal.travel : most;
  setpoints_.begin(start_);
}

void TouchNode::step() {
  if (!isActive()) return;
  if (const std::string reason = setpoints_.interruption(); !reason.empty()) return finish(false, reason);
  if (!search_) {
    if (!setpoints_.engage()) return;
    TouchSearchConfig config = parameters_.search;
    config.largest_travel = travel_;
    const Eigen::Vector3d direction = -watch_.poseAt(start_).linear().col(2);  // z points away from the cell
    search_ = std::make_unique<TouchSearch>(config, start_, direction, input());
  }
  const auto setpoint = search_->step(input());
  if (setpoint) setpoints_.publish(*setpoint);
  Feedback feedback;
  feedback.travel = search_->travel();
  feedback.displacement = search_->displacement();
  feedback.force = search_->force().value_or(std::nan(""));
  feedback.waits_for = search_->waitsFor();
  publishFeedback(feedback);
  if (search_->done()) return finish(true, search_->text());
  if (!search_->failure().empty()) finish(false, search_->failure());
}

TouchNode::Result TouchNode::end(bool success) {
  Result result;
  result.travel = result.interval = result.depth = std::nan("");
  for (int i = 0; i < 3; ++i) result.contact[i] = success ? search_->contact()[i] : std::nan("");
  result.force = search_ ? search_->force().value_or(std::nan("")) : std::nan("");
  if (success) {
    result.travel = search_->touchTravel();
    result.interval = search_->interval();
    result.depth = search_->travel() - search_->touchTravel();
    result.force = search_->restingForce().value_or(std::nan(""));
  }
  search_.reset();
  setpoints_.end();
  return result;
}

void TouchNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, isActive() ? "lowers the needle" : "waits for a goal");
  if (search_ && !search_->waitsFor().empty())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "waits for: " + search_->waitsFor());
  bus_.refusals().report(status);
  status.add("last goal", outcome());
}

}  // namespace microinjection
