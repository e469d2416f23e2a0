#include "nodes/touch_node.h"

#include <cmath>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {
namespace {

constexpr double kPatience = 10;   // s, for the controller to connect
constexpr double kEngaging = 0.5;  // s: the controller counts a hand's targets from the first that it has received
constexpr double kPeriod = 0.005;  // s of wall time: the controller takes a target of 0.05 s ago for stale
constexpr char kSetpoints[] = "/teleop/servo_cp";

}  // namespace

const char* const TouchNode::kHelp =
    "touch: lowers the needle until the image shows that it touches the cell.\n"
    "In: vision/state, /needle/measured_cp, /controller/operating_state, /force_sensor/measured_cf.\n"
    "Out: /teleop/servo_cp; action touch/find.\n";

TouchNode::Parameters TouchNode::readParameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  parameters.search = TouchSearchConfig::read(reader);
  reader.finish();
  return parameters;
}

TouchNode::TouchNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(readParameters(private_node)),
      node_(node),
      watch_(node, parameters_.input_timeout),
      others_(subscribeGuarded<geometry_msgs::PoseStamped>(
          node, kSetpoints, 1, [](const geometry_msgs::PoseStamped&, const std::string&) {})),
      vision_(subscribeGuarded<cell_microinjection::VisionState>(
          node, "vision/state", 1,
          [this](const cell_microinjection::VisionState& message, const std::string&) { onVision(message); })),
      forces_(subscribeGuarded<geometry_msgs::WrenchStamped>(
          node, "/force_sensor/measured_cf", 1,
          [this](const geometry_msgs::WrenchStamped& message, const std::string&) { onForce(message); })),
      action_(node, "touch/find", false),
      diagnostics_(node, private_node) {
  action_.registerGoalCallback([this] { onGoal(); });
  action_.registerPreemptCallback([this] {
    if (active_) finish(false, "cancelled");
  });
  action_.start();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("touch", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, active_ ? "lowers the needle" : "waits for a goal");
    if (search_ && !search_->waitsFor().empty())
      status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "waits for: " + search_->waitsFor());
    MessageRefusals::ofProcess().report(status);
    status.add("last goal", outcome_);
  });
  timer_ = node.createSteadyTimer(ros::WallDuration(kPeriod), [this](const ros::SteadyTimerEvent&) { step(); });
}

void TouchNode::run() { ros::spin(); }

void TouchNode::onVision(const cell_microinjection::VisionState& message) {
  sight_.reset();
  const auto& tip = message.injection_pipette;
  const auto& cell = message.cell;
  const auto& beside = message.indentation;
  sight_arrival_ = Arrival(message.header.stamp);
  blind_ = "the image is old, or stamped ahead";
  if (sight_arrival_.isOld(parameters_.input_timeout)) return;
  blind_ = "the cell is not found: " + cell.reason;
  if (cell.verdict == cell.NOT_FOUND) return;
  blind_ = "the tip is not found: " + tip.reason;
  if (tip.verdict == tip.NOT_FOUND) return;
  blind_ = "the outline beside the needle is not clear: " + beside.reason;
  const bool certain = cell.verdict == cell.FOUND && tip.verdict == tip.FOUND;
  const TouchSearch::Sight sight{message.header.stamp.toSec(), beside.displacement, beside.displacement_deviation,
                                 beside.gap, certain};
  if (!std::isfinite(sight.displacement + sight.deviation + sight.gap)) return;
  blind_.clear();
  sight_ = sight;
}

/// An invalid reading is as none: force_timeout after the last valid one the search fails.
void TouchNode::onForce(const geometry_msgs::WrenchStamped& message) {
  const Arrival arrival(message.header.stamp);
  const std::optional<Eigen::Vector3d> force = finiteForce(&message);
  if (message.header.stamp.isZero() || arrival.isOld(parameters_.force_timeout) || !force) return;
  force_ = force->z();
  force_stamp_ = message.header.stamp.toSec();
  force_arrival_ = arrival;
}

TouchSearch::Input TouchNode::input() const {
  TouchSearch::Input input{
      ros::Time::now().toSec(), watch_.position(), watch_.restedSince(), sight_, blind_, force_, force_stamp_};
  if (sight_arrival_.isOld(parameters_.input_timeout)) input.sight.reset();
  if (force_arrival_.isOld(parameters_.force_timeout)) input.force.reset();
  return input;
}

void TouchNode::onGoal() {
  const auto goal = action_.acceptNewGoal();
  search_.reset();
  try {
    begin(goal->travel);
  } catch (const std::exception& error) {
    finish(false, error.what());
  }
}

void TouchNode::begin(double travel) {
  const double most = parameters_.search.largest_travel;
  if (!Range::closed(0, most).contains(travel))
    throw ConfigError("travel = " + std::to_string(travel) + " m: must be from 0 to " + std::to_string(most) + " m");
  if (watch_.controller().state != "ENABLED")
    throw ConfigError("the controller is " + watch_.controller().state + ", must be ENABLED");
  if (others_.getNumPublishers() > 0) throw ConfigError(std::string("another node publishes ") + kSetpoints);
  if (const std::string reason = watch_.cellInTheWay(); !reason.empty()) throw ConfigError(reason);
  const std::optional<Eigen::Vector3d> position = watch_.position();
  if (!position) throw ConfigError("/needle/measured_cp is silent or invalid");
  const auto sight = input().sight;
  if (!sight) throw ConfigError("the image does not show the touch: " + (blind_.empty() ? "the image is old" : blind_));
  if (forces_.getNumPublishers() > 0 && !input().force)
    throw ConfigError("/force_sensor/measured_cf is silent or invalid: the force could not be watched");
  if (!sight->certain) throw ConfigError("the cell or the tip is uncertain in the image");
  travel_ = travel > 0 ? travel : most;
  start_ = *position;
  active_ = true;
  accepted_ = began_ = ros::SteadyTime::now();
  setpoints_ = node_.advertise<geometry_msgs::PoseStamped>(kSetpoints, 1);
}

bool TouchNode::isEngaged() {
  // This node's own subscription is one of them.
  if (setpoints_.getNumSubscribers() < 2) began_ = ros::SteadyTime::now();
  return secondsBetween(began_, ros::SteadyTime::now()) > kEngaging;
}

void TouchNode::step() {
  diagnostics_.update();
  endIfOrphaned(master_);
  if (!active_) return;
  if (watch_.controller().state != "ENABLED") return finish(false, "the controller is " + watch_.controller().state);
  if (others_.getNumPublishers() > 1) return finish(false, std::string("another node publishes ") + kSetpoints);
  const ros::Time now = ros::Time::now();
  if (!search_) {
    setpoints_.publish(toPose(watch_.poseAt(start_), now, kWorldFrame));
    if (secondsBetween(accepted_, ros::SteadyTime::now()) > kPatience)
      return finish(false, "the controller does not follow " + std::string(kSetpoints) + ": its mode must be manual");
    if (!isEngaged()) return;
    TouchSearchConfig config = parameters_.search;
    config.largest_travel = travel_;
    const Eigen::Vector3d direction = -watch_.poseAt(start_).linear().col(2);  // z points away from the cell
    search_ = std::make_unique<TouchSearch>(config, start_, direction, input());
  }
  const auto setpoint = search_->step(input());
  if (setpoint) setpoints_.publish(toPose(watch_.poseAt(*setpoint), now, kWorldFrame));
  cell_microinjection::FindTouchFeedback feedback;
  feedback.travel = search_->travel();
  feedback.displacement = search_->displacement();
  feedback.force = search_->force().value_or(std::nan(""));
  feedback.waits_for = search_->waitsFor();
  action_.publishFeedback(feedback);
  if (search_->done()) return finish(true, search_->text());
  if (!search_->failure().empty()) finish(false, search_->failure());
}

// By value: the search that has the text ends here.
void TouchNode::finish(bool success, std::string message) {  // NOLINT(performance-unnecessary-value-param)
  outcome_ = message;
  cell_microinjection::FindTouchResult result;
  result.success = static_cast<unsigned char>(success);
  result.message = message;
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
  active_ = false;
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
  return microinjection::runNode<microinjection::TouchNode>(argc, argv, "touch", microinjection::Priority::kOrdinary);
}
