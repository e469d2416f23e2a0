#include "nodes/injection_controller_node.h"

#include <algorithm>
#include <limits>

#include "nodes/conversions.h"
#include "nodes/force_topic.h"
#include "nodes/node_parameters.h"

namespace microinjection {

const char* const InjectionControllerNode::kHelp =
    "injection_controller: decides where the needle goes and holds it when an input cannot be trusted.\n"
    "In: /teleop/servo_cp /needle/measured_cp, /cell/predicted_cf or /force_sensor/measured_cf,\n"
    "/controller/state_command (enable, disable, pause, resume, home, approach, indent, inject, withdraw),
    "
    "/needle/abilities. Out: /needle/servo_cp /controller/operating_state.
    "
    "Parameters: ~mode (manual|semi_automatic|automatic), ~force_source (predicted|measured), ~speed_limit (m/s),
    "
    "~jump_limit (m), ~lag_limit (m), ~force_limit (N), ~detection/... ~motion/... ~goal/... ~auto_enable, ~rate (Hz),
    "
    "~input_timeout (s); see
    "
    "config/injection_controller.yaml.\n";

InjectionControllerNode::Parameters InjectionControllerNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  reader.choice("force_source", parameters.force_source, {"predicted", "measured"});
  reader.boolean("auto_enable", parameters.auto_enable);
  reader.number("lag_limit", parameters.lag_limit, Range::positive());
  parameters.model = InjectionControllerConfig::read(reader);
  reader.finish();
  return parameters;
}

InjectionControllerNode::InjectionControllerNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      model_(parameters_.model),
      cycle_(node, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", Phase::kTickBefore,
                                                       parameters_.input_timeout)),
      force_(cycle_.input<geometry_msgs::WrenchStamped>(forceTopic(parameters_.force_source), Phase::kTickBefore,
                                                        parameters_.input_timeout)),
      setpoint_(cycle_.output<geometry_msgs::PoseStamped>("needle/servo_cp")) {
  if (parameters_.model.mode == "manual") {
    target_ = &cycle_.input<geometry_msgs::PoseStamped>("teleop/servo_cp", Phase::kSameTick, parameters_.input_timeout);
  }
  state_ = cycle_.node().advertise<cell_microinjection::OperatingState>("controller/operating_state", 10, true);
  commands_ = cycle_.node().subscribe<cell_microinjection::StringStamped>(
      "controller/state_command", 10,
      [this](const cell_microinjection::StringStampedConstPtr& message) { obey(message->string); });
  abilities_ = cycle_.node().subscribe<cell_microinjection::ManipulatorAbilities>(
      "needle/abilities", 1,
      [this](const cell_microinjection::ManipulatorAbilitiesConstPtr& message) { adaptTo(*message); });
  cycle_.diagnostics().add("control", [this](auto& status) { report(status); });
  if (parameters_.auto_enable) obey("enable");
}

void InjectionControllerNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void InjectionControllerNode::obey(const std::string& command) {
  const std::string refusal = model_.command(command);
  if (refusal.empty()) {
    ROS_INFO_STREAM("state command " << command << ": " << toText(model_.state()));
  } else {
    ROS_WARN_STREAM("state command " << command << " refused: " << refusal);
  }
}

void InjectionControllerNode::adaptTo(const cell_microinjection::ManipulatorAbilities& rig) {
  const double lag = rig.latency + rig.command_interval;
  rig_speed_ = lag > 0 ? parameters_.lag_limit / lag : std::numeric_limits<double>::infinity();
  model_.limitSpeed(rig_speed_);
  ROS_INFO_STREAM("rig: " << rig.device << ", driven at " << std::min(rig_speed_, parameters_.model.guards.speed_limit)
                          << " m/s at the most");
}

void InjectionControllerNode::step(const Cycle::Tick& tick) {
  const auto* target = target_ ? target_->get(tick.now) : nullptr;
  const auto needle = trustedPose(needle_.get(tick.now));
  InjectionController::Input input;
  input.target = trustedPosition(target, kWorldFrame);
  if (needle) {
    input.needle = needle->translation();
    input.axis = needle->linear().col(2);
    input.force = trustedForce(force_.get(tick.now), needle->linear());
  }
  if (const auto setpoint = model_.step(input, tick.dt)) {
    Eigen::Isometry3d pose = needle ? *needle : Eigen::Isometry3d::Identity();
    pose.translation() = *setpoint;
    setpoint_.publish(toPose(pose, target && model_.followsTarget() ? target->header.stamp : tick.now, kWorldFrame));
  }
  publishState(tick.now);
}

void InjectionControllerNode::publishState(const ros::Time& now) {
  cell_microinjection::OperatingState state;
  state.state = toText(model_.state());
  state.is_homed = model_.homed();
  state.is_busy = model_.busy();
  if (state.state == said_.state && state.is_homed == said_.is_homed && state.is_busy == said_.is_busy) return;
  state.header.stamp = now;
  state_.publish(state);
  said_ = state;
}

void InjectionControllerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const bool fault = model_.state() == OperatingState::kFault;
  const bool good = model_.heldBecause().empty();
  status.summary(fault  ? diagnostic_msgs::DiagnosticStatus::ERROR
                 : good ? diagnostic_msgs::DiagnosticStatus::OK
                        : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? "the needle follows" : "needle held: " + model_.heldBecause());
  status.add("state", toText(model_.state()));
  status.add("speed limit (m/s)", std::min(rig_speed_, parameters_.model.guards.speed_limit));
}

}  // namespace microinjection
