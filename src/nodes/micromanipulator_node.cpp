#include "nodes/micromanipulator_node.h"

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kOtherTimeout = 0.2;  // s, of the other manipulator's place

std::string urdfFromParameter(const Bus& bus) {
  const YAML::Node urdf = bus.parameter("/robot_description");
  if (!urdf.IsScalar()) {
    throw ConfigError("/robot_description is missing: it must hold the rig's URDF (urdf/rig.urdf)");
  }
  return urdf.Scalar();
}

bool isNeedle(const std::string& tip) { return tip == "needle_tip"; }

}  // namespace

const char* const MicromanipulatorNode::kHelp =
    "micromanipulator: a three-axis micromanipulator, simulated, emulated or real, with CRTK topics below /needle.\n"
    "In: /needle/servo_cp /needle/servo_cv /needle/move_cp /needle/state_command (enable, disable, pause, resume,\n"
    "home, unhome, stop). Out: /needle/measured_cp /needle/measured_cv /needle/setpoint_cp /needle/abilities\n"
    "/needle/operating_state /needle/loop_state joint_states.\n";

MicromanipulatorNode::Parameters MicromanipulatorNode::Parameters::read(ConfigReader& reader) {
  Parameters parameters;
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("joint_states_rate", parameters.joint_states_rate, {0, 1000, true, false});
  reader.text("rig", parameters.rig);
  reader.boolean("emulated", parameters.emulated);
  reader.boolean("allow_network", parameters.allow_network);
  reader.boolean("auto_enable", parameters.auto_enable);
  reader.text("tip", parameters.tip);
  ConfigReader other = reader.section("other");
  other.text("tip", parameters.other_tip);
  other.number("tilt", parameters.other_tilt);
  parameters.model = MicromanipulatorConfig::read(reader);
  return parameters;
}

MicromanipulatorNode::MicromanipulatorNode(Bus& bus) : MicromanipulatorNode(bus, parameterReader(bus)) {}

MicromanipulatorNode::MicromanipulatorNode(Bus& bus, ConfigReader reader)
    : parameters_(Parameters::read(reader)),
      geometry_(ManipulatorGeometry::fromUrdf(urdfFromParameter(bus), parameters_.model.pipette_tilt, parameters_.tip)),
      other_geometry_(parameters_.other_tip.empty()
                          ? std::nullopt
                          : std::optional(ManipulatorGeometry::fromUrdf(urdfFromParameter(bus), parameters_.other_tilt,
                                                                        parameters_.other_tip))),
      cycle_(bus, parameters_.rate),
      rig_(makeManipulatorSetup(parameters_.rig, parameters_.emulated, geometry_, cycle_, reader.section("device"),
                                reader.section("emulator"))),
      model_(geometry_,
             CollisionGuard(urdfFromParameter(bus), geometry_, parameters_.model.collision_margin,
                            other_geometry_ ? &*other_geometry_ : nullptr,
                            isNeedle(parameters_.tip) ? CollisionGuard::Role::kCapsule : CollisionGuard::Role::kSolid),
             parameters_.model, *rig_.device),
      commands_(cycle_, parameters_.model, rig_, model_,
                {parameters_.allow_network, parameters_.auto_enable, isNeedle(parameters_.tip),
                 isNeedle(parameters_.tip) ? "the needle" : "the holding pipette"}),
      publisher_(cycle_, geometry_, rig_, model_, parameters_.joint_states_rate),
      loop_state_(bus, "needle/loop_state") {
  if (cycle_.bus().isVirtual() && rig_.moves_in_real_time) {
    throw ConfigError("rig = " + parameters_.rig +
                      ": a real rig cannot run in virtual time, it moves on while time stands");
  }
  if (other_geometry_) {
    other_ = &cycle_.input<geometry_msgs::PoseStamped>("other_rig/measured_cp", InputPhase::kSampled, kOtherTimeout);
    cycle_.diagnostics().add("other manipulator", [this](auto& status) { reportOther(status); });
  }
  cycle_.diagnostics().add("commands", [this](auto& status) { commands_.report(status); });
  if (rig_.report) cycle_.diagnostics().add("rig", rig_.report);
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

/// Where the other one is not known it stays an obstacle where it was last, at first with all joints at 0.
void MicromanipulatorNode::followOther() {
  const auto message = other_->takeUpdates();
  if (const auto pose = validPose(message.get())) model_.placeOther(other_geometry_->joints(pose->translation()));
}

void MicromanipulatorNode::reportOther(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const bool fresh = other_->fresh(cycle_.bus().now());
  status.summary(fresh ? DiagnosticStatus::OK : DiagnosticStatus::WARN,
                 fresh ? "its links are obstacles"
                       : "the place of the other manipulator is not known: it is an obstacle where it was last");
}

void MicromanipulatorNode::step(const Cycle::Tick& tick) {
  if (other_) followOther();
  commands_.step(tick);
  if (rig_.before_step) rig_.before_step(commands_.time());
  model_.step(commands_.time(), tick.dt);
  commands_.endStep();
  publisher_.publish(tick.now);
  publishState(tick);
  loop_state_.step(commands_.streamHold(), tick.now);
  cycle_.bus().setBusy(commands_.moves());
}

void MicromanipulatorNode::publishState(const Cycle::Tick& tick) {
  cell_microinjection::OperatingState state;
  state.is_busy = commands_.isBusy(tick);
  if (commands_.busyIsPending() && state.is_busy == publisher_.lastPublishedState().is_busy) return;
  state.state = toText(commands_.state().state());
  state.is_homed = commands_.state().homed();
  if (!publisher_.publishState(state, tick.now, commands_.takeStateCommandReceived())) return;
  const std::string reason = model_.reason().empty() ? commands_.unavailableReason() : model_.reason();
  ROS_INFO_STREAM(state.state << (reason.empty() ? "" : ": ") << reason);
}

}  // namespace microinjection
