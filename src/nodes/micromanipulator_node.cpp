#include "nodes/micromanipulator_node.h"

#include "base/errors.h"
#include "nodes/conversions.h"
#include "nodes/latency_meter.h"
#include "nodes/node_parameters.h"

namespace microinjection {
namespace {

std::string urdfFromParameter() {
  std::string urdf;
  if (!ros::param::get("/robot_description", urdf)) {
    throw ConfigError("/robot_description is missing: it must hold the rig's URDF (urdf/rig.urdf)");
  }
  return urdf;
}

}  // namespace

const char* const MicromanipulatorNode::kHelp =
    "micromanipulator: a simulated three-axis micromanipulator with CRTK topics below /needle.\n"
    "In: /needle/servo_cp /needle/servo_cv /needle/move_cp. Out: /needle/measured_cp /needle/measured_cv "
    "joint_states.\n"
    "Parameters: /robot_description, ~rate (Hz), ~joint_states_rate (Hz), ~command_timeout (s), "
    "~velocity_command_timeout (s),\n"
    "~pipette_tilt (rad), ~collision_margin (m), ~simulated/...; see config/micromanipulator.yaml.\n";

MicromanipulatorNode::Parameters MicromanipulatorNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("joint_states_rate", parameters.joint_states_rate, {0, 1000, true, false});
  parameters.model = MicromanipulatorConfig::read(reader);
  ConfigReader simulated = reader.section("simulated");
  parameters.device = SimulatedManipulatorConfig::read(simulated);
  reader.finish();
  return parameters;
}

MicromanipulatorNode::MicromanipulatorNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      geometry_(ManipulatorGeometry::fromUrdf(urdfFromParameter(), parameters_.model.pipette_tilt)),
      device_(geometry_, parameters_.device),
      model_(geometry_, CollisionGuard(urdfFromParameter(), geometry_, parameters_.model.collision_margin),
             parameters_.model, device_),
      cycle_(node, parameters_.rate),
      servo_(cycle_.input<geometry_msgs::PoseStamped>("needle/servo_cp", Phase::kSameTick,
                                                      parameters_.model.command_timeout)),
      measured_(cycle_.output<geometry_msgs::PoseStamped>("needle/measured_cp")),
      velocity_(cycle_.output<geometry_msgs::TwistStamped>("needle/measured_cv")),
      trace_(cycle_.output<cell_microinjection::LatencyTrace>("needle/setpoint_trace")) {
  servo_velocity_ = cycle_.node().subscribe<geometry_msgs::TwistStamped>(
      "needle/servo_cv", 10, [this](const geometry_msgs::TwistStampedConstPtr& message) {
        const auto velocity = trustedVelocity(message.get());
        judge("servo_cv", velocity ? model_.servoVelocity(*velocity, now_.toSec()) : "not a valid velocity in world");
      });
  move_ = cycle_.node().subscribe<geometry_msgs::PoseStamped>(
      "needle/move_cp", 10, [this](const geometry_msgs::PoseStampedConstPtr& message) {
        const auto pose = trustedPose(message.get());
        judge("move_cp", pose ? model_.movePosition(*pose) : "not a valid pose in world");
      });
  joint_states_ = node.advertise<sensor_msgs::JointState>("joint_states", 10);
  cycle_.diagnostics().add("commands", [this](auto& status) { report(status); });
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

void MicromanipulatorNode::obeyServo(const Cycle::Tick& tick) {
  const auto message = servo_.takeNews();
  if (!message) return;
  if (!servo_.fresh(tick.now)) return judge("servo_cp", "it is stale");
  const auto pose = trustedPose(message.get());
  judge("servo_cp", pose ? model_.servoPosition(*pose) : "not a valid pose in world");
  if (!isTraced(tick.now)) return;
  cell_microinjection::LatencyTrace trace;
  trace.header.stamp = tick.now;
  trace.origin = message->header.stamp;
  trace_.publish(trace);
}

void MicromanipulatorNode::step(const Cycle::Tick& tick) {
  now_ = tick.now;
  obeyServo(tick);
  model_.step(tick.now.toSec(), tick.dt);
  publish(tick);
  if ((tick.now - joint_states_sent_).toSec() >= 1 / parameters_.joint_states_rate) publishJointStates(tick.now);
}

void MicromanipulatorNode::publish(const Cycle::Tick& tick) {
  if (const auto pose = model_.tipPose()) measured_.publish(toPose(*pose, tick.now, kWorldFrame));
  if (const auto velocity = model_.tipVelocity()) velocity_.publish(toTwist(*velocity, tick.now, kWorldFrame));
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
  const bool good = refusal_.empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? (model_.moving() ? "moves" : "holds") : refusal_);
  status.add("commands refused", refused_);
}

}  // namespace microinjection
