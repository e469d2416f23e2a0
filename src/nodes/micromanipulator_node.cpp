#include "nodes/micromanipulator_node.h"

#include <algorithm>

#include "base/errors.h"
#include "nodes/conversions.h"
#include "nodes/latency_meter.h"
#include "nodes/node_parameters.h"

namespace microinjection {
namespace {

// s: what a publisher latched, and a node that starts anew hears again, must not move the needle a second time.
constexpr double kOldestMove = 3;

constexpr double kAbilitiesPeriod = 1;  // s

std::string urdfFromParameter() {
  std::string urdf;
  if (!ros::param::get("/robot_description", urdf)) {
    throw ConfigError("/robot_description is missing: it must hold the rig's URDF (urdf/rig.urdf)");
  }
  return urdf;
}

}  // namespace

const char* const MicromanipulatorNode::kHelp =
    "micromanipulator: a three-axis micromanipulator, simulated, emulated or real, with CRTK topics below /needle.\n"
    "In: /needle/servo_cp /needle/servo_cv /needle/move_cp /needle/state_command (enable, disable, stop). Out:\n"
    "/needle/measured_cp /needle/measured_cv /needle/abilities /needle/operating_state joint_states.\n"
    "Parameters: /robot_description, ~rig (sim|eppendorf|mp285|scientifica|zaber), ~emulated, ~device/...\n"
    "(src/rigs/NAME/NAME.yaml), ~emulator/... (what an emulated device is like), ~rate (Hz),\n"
    "~joint_states_rate (Hz), ~command_timeout (s), ~velocity_command_timeout (s), ~servo_speed_limit (m/s),\n"
    "~pipette_tilt (rad), ~collision_margin (m), ~allow_network; see config/micromanipulator.yaml. With a serial "
    "device:\n"
    "  rosrun cell_microinjection micromanipulator _rig:=zaber _device/port/path:=/dev/ttyUSB0\n";

MicromanipulatorNode::Parameters MicromanipulatorNode::Parameters::read(ConfigReader& reader) {
  Parameters parameters;
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("joint_states_rate", parameters.joint_states_rate, {0, 1000, true, false});
  reader.text("rig", parameters.rig);
  reader.boolean("emulated", parameters.emulated);
  reader.boolean("allow_network", parameters.allow_network);
  parameters.model = MicromanipulatorConfig::read(reader);
  return parameters;
}

MicromanipulatorNode::MicromanipulatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : MicromanipulatorNode(node, parameterReader(private_node)) {}

MicromanipulatorNode::MicromanipulatorNode(const ros::NodeHandle& node, ConfigReader reader)
    : parameters_(Parameters::read(reader)),
      geometry_(ManipulatorGeometry::fromUrdf(urdfFromParameter(), parameters_.model.pipette_tilt)),
      rig_(makeRigDevice(parameters_.rig, parameters_.emulated, geometry_, reader.section("device"),
                         reader.section("emulator"))),
      model_(geometry_, CollisionGuard(urdfFromParameter(), geometry_, parameters_.model.collision_margin),
             parameters_.model, *rig_.device),
      cycle_(node, parameters_.rate),
      servo_(cycle_.input<geometry_msgs::PoseStamped>("needle/servo_cp", Phase::kSameTick,
                                                      parameters_.model.command_timeout)),
      measured_(cycle_.output<geometry_msgs::PoseStamped>("needle/measured_cp")),
      velocity_(cycle_.output<geometry_msgs::TwistStamped>("needle/measured_cv")),
      trace_(cycle_.output<cell_microinjection::LatencyTrace>("needle/setpoint_trace")) {
  if (cycle_.lockstep() && !rig_.inject) {
    throw ConfigError("rig = " + parameters_.rig +
                      ": a real one takes no part in lock step, it goes on while time stands");
  }
  if (!rig_.inject && !parameters_.allow_network) network_ = std::make_unique<NetworkWatch>();
  if (rig_.true_joints) true_ = &cycle_.output<geometry_msgs::PoseStamped>("needle/true_cp");
  subscribe();
  joint_states_ = cycle_.node().advertise<sensor_msgs::JointState>("joint_states", 10);
  state_ = cycle_.node().advertise<cell_microinjection::OperatingState>("needle/operating_state", 10, true);
  abilities_ = cycle_.node().advertise<cell_microinjection::ManipulatorAbilities>("needle/abilities", 10, true);
  publishAbilities(ros::Time::now());
  cycle_.diagnostics().add("commands", [this](auto& status) { report(status); });
}

void MicromanipulatorNode::subscribe() {
  using cell_microinjection::StringStamped;
  ros::NodeHandle& node = cycle_.node();
  // Of each message that comes between two steps, also of those that a newer one replaces.
  servo_.listen([this](const geometry_msgs::PoseStamped& message, const ros::Time& now) {
    if (secondsBetween(message.header.stamp, now) <= parameters_.model.command_timeout) authorize(servo_.sender);
  });
  subscribers_.push_back(subscribeGuarded<geometry_msgs::TwistStamped>(
      node, "needle/servo_cv", 10,
      [this](const geometry_msgs::TwistStamped& message, const std::string& sender) { onVelocity(message, sender); }));
  subscribers_.push_back(subscribeGuarded<geometry_msgs::PoseStamped>(
      node, "needle/move_cp", 10,
      [this](const geometry_msgs::PoseStamped& message, const std::string& sender) { onMove(message, sender); }));
  subscribers_.push_back(subscribeGuarded<StringStamped>(
      node, "needle/state_command", 10,
      [this](const StringStamped& message, const std::string&) {
        judge("state_command", obeyState(message));
        answer_ = true;
      },
      StampRule::kAny));
  if (!rig_.inject) return;
  subscribers_.push_back(subscribeGuarded<StringStamped>(node, "needle/emulated_fault", 10,
                                                         [this](const StringStamped& message, const std::string&) {
                                                           answer_ = true;
                                                           try {
                                                             rig_.inject(message.string, time());
                                                           } catch (const ConfigError& error) {
                                                             judge("emulated_fault", error.what());
                                                           }
                                                         }));
}

void MicromanipulatorNode::onVelocity(const geometry_msgs::TwistStamped& message, const std::string& sender) {
  const auto velocity = trustedVelocity(&message);
  if (!velocity) return judge("servo_cv", "not a valid velocity in world");
  const double old = std::max(0.0, age(message.header));
  if (old > parameters_.model.velocity_command_timeout) return judge("servo_cv", "it is stale");
  authorize(sender);
  const std::string why = unable();
  judge("servo_cv", why.empty() ? model_.servoVelocity(*velocity, time() - old) : why);
}

void MicromanipulatorNode::onMove(const geometry_msgs::PoseStamped& message, const std::string& sender) {
  const auto pose = trustedPose(&message);
  if (!pose) return judge("move_cp", "not a valid pose in world");
  if (age(message.header) > kOldestMove) return judge("move_cp", "it is stale");
  authorize(sender);
  const std::string why = unable();
  judge("move_cp", why.empty() ? model_.movePosition(*pose) : why);
}

void MicromanipulatorNode::authorize(const std::string& sender) {
  if (!unable().empty()) return;
  if (authority_.admit(sender, time(), moves())) return;
  model_.stop();
  ROS_ERROR_STREAM(authority_.fault());
}

/// A device that is not there is not known to move.
bool MicromanipulatorNode::moves() const {
  const bool there = model_.state() != ManipulatorDevice::State::kDisconnected;
  return there && (model_.moving() || rig_.device->moving());
}

/// Decides whether the rig may be enabled. A needle that may be in a cell keeps its way out when an interface comes up.
void MicromanipulatorNode::lookAtNetwork() {
  if (!network_) return;
  const bool reachable = network_->reachable();
  if (disabled_) admitted_ = false;
  admitted_ = admitted_ || (!reachable && !disabled_);
  exposed_ = reachable && !admitted_;
}

void MicromanipulatorNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void MicromanipulatorNode::judge(const std::string& command, const std::string& refusal) {
  refusal_ = refusal.empty() ? "" : command + " refused: " + refusal;
  if (refusal_.empty()) return;
  ++refused_;
  ROS_WARN_STREAM_THROTTLE(1, refusal_);
}

std::string MicromanipulatorNode::unable() const {
  if (master_lost_) return "the ROS master is lost";
  if (!authority_.fault().empty()) return authority_.fault() + "; allowed after enable";
  if (exposed_) {
    return "others can reach this machine's nodes through " + network_->interfaces() +
           "; allowed without these interfaces (./dev shell --isolated), or with allow_network = true";
  }
  return disabled_ ? "DISABLED; allowed after enable" : "";
}

/// What stops is obeyed whatever its stamp.
std::string MicromanipulatorNode::obeyState(const cell_microinjection::StringStamped& message) {
  const std::string& command = message.string;
  if (command == "stop" || command == "disable") {
    model_.stop();
    disabled_ = disabled_ || command == "disable";
  } else if (command == "enable") {
    if (!isTimely("needle/state_command", message, now_)) return "its stamp is ahead";
    disabled_ = false;
    authority_.clear();
    model_.clearFault();
  } else {
    return "\"" + command + "\" is no command here; allowed: enable, disable, stop";
  }
  return "";
}

void MicromanipulatorNode::obeyServo(const Cycle::Tick& tick) {
  const auto message = servo_.takeNews();
  if (!message) return;
  if (!servo_.fresh(tick.now)) return judge("servo_cp", master_lost_ ? unable() : "it is stale");
  const auto pose = trustedPose(message.get());
  if (!pose) return judge("servo_cp", "not a valid pose in world");
  const std::string why = unable();
  judge("servo_cp", why.empty() ? model_.servoPosition(*pose) : why);
  if (!isTraced(tick.now)) return;
  cell_microinjection::LatencyTrace trace;
  trace.header.stamp = tick.now;
  trace.origin = message->header.stamp;
  trace_.publish(trace);
}

void MicromanipulatorNode::step(const Cycle::Tick& tick) {
  if (tick.now < now_) set_back_ += secondsBetween(tick.now, now_);
  now_ = tick.now;
  // What goes on by itself, too: nobody new could stop it.
  if (cycle_.masterLost() && !master_lost_) model_.stop();
  master_lost_ = cycle_.masterLost();
  lookAtNetwork();
  obeyServo(tick);
  if (rig_.before_step) rig_.before_step(time());
  model_.step(time(), tick.dt);
  publish(tick);
  publishState(tick.now);
  publishAbilities(tick.now);
  cycle_.setBusy(moves());
  if (secondsBetween(joint_states_sent_, tick.now) >= 1 / parameters_.joint_states_rate) publishJointStates(tick.now);
}

void MicromanipulatorNode::publish(const Cycle::Tick& tick) {
  if (const auto pose = model_.tipPose()) {
    measured_.publish(toPose(*pose, tick.now, kWorldFrame));
    velocity_.publish(toTwist(*model_.tipVelocity(), tick.now, kWorldFrame));
  } else {
    measured_.publishInvalid(toPose(Eigen::Isometry3d::Identity(), tick.now, kWorldFrame));
    velocity_.publishInvalid(toTwist(Eigen::Vector3d::Zero(), tick.now, kWorldFrame));
  }
  if (true_) true_->publish(toPose(geometry_.tipPose(rig_.true_joints()), tick.now, kWorldFrame));
}

void MicromanipulatorNode::publishState(const ros::Time& now) {
  using State = ManipulatorDevice::State;
  cell_microinjection::OperatingState state;
  const bool there = model_.state() != State::kDisconnected && !disabled_ && !exposed_;
  const bool fault = model_.state() == State::kFault || !authority_.fault().empty();
  state.state = fault ? "FAULT" : there ? "ENABLED" : "DISABLED";
  state.is_homed = model_.tipPose().has_value();  // axes are absolute
  state.is_busy = moves();
  const bool same = state.state == said_.state && state.is_homed == said_.is_homed && state.is_busy == said_.is_busy;
  if (same && !answer_) return;
  answer_ = false;
  if (state.state != said_.state) {
    const std::string why = model_.why().empty() && state.state != "ENABLED" ? unable() : model_.why();
    ROS_INFO_STREAM(state.state << (why.empty() ? "" : ": ") << why);
  }
  state.header.stamp = now;
  state_.publish(state);
  said_ = state;
}

void MicromanipulatorNode::publishAbilities(const ros::Time& now) {
  const ManipulatorAbilities abilities = rig_.device->abilities();
  cell_microinjection::ManipulatorAbilities message;
  message.header.stamp = told_.header.stamp;
  message.device = abilities.device;
  message.follows = abilities.follows;
  message.command_interval = abilities.command_interval;
  message.reading_interval = abilities.reading_interval;
  message.resolution = abilities.resolution;
  message.speed = abilities.speed;
  message.latency = abilities.latency;
  message.stop_time = abilities.stop_time;
  // Said again for who heard something else meanwhile.
  if (message == told_ && secondsBetween(told_.header.stamp, now) < kAbilitiesPeriod) return;
  message.header.stamp = now;
  abilities_.publish(message);
  told_ = message;
}

void MicromanipulatorNode::publishJointStates(const ros::Time& now) {
  const auto joints = model_.joints();
  if (!joints) return;
  sensor_msgs::JointState message;
  message.header.stamp = now;
  for (int i = 0; i < 3; ++i) {
    message.name.push_back(geometry_.axes[i].joint);
    message.position.push_back((*joints)[i]);
  }
  if (!geometry_.tilt.joint.empty()) {
    message.name.push_back(geometry_.tilt.joint);
    message.position.push_back(geometry_.tilt.angle);
  }
  joint_states_.publish(message);
  joint_states_sent_ = now;
}

void MicromanipulatorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  std::string problem = refusal_;
  if (problem.empty()) problem = model_.ended();
  const std::string why = model_.why().empty() && (exposed_ || !authority_.fault().empty()) ? unable() : model_.why();
  if (!why.empty() && problem != why) problem = why + (problem.empty() ? "" : "; ") + problem;
  status.summary(
      why.empty() ? problem.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN : DiagnosticStatus::ERROR,
      problem.empty() ? (model_.moving() ? "moves" : "holds") : problem);
  status.add("device", rig_.device->abilities().device);
  status.add("device's note", rig_.device->note());
  if (network_ && network_->reachable() && admitted_) {
    status.mergeSummary(DiagnosticStatus::ERROR, "others can reach this machine now through " + network_->interfaces() +
                                                     ": after disable it is not enabled again");
  }
  status.add("commands refused", refused_);
}

}  // namespace microinjection
