#include "nodes/teleoperation_follower_node.h"

#include <limits>

#include "nodes/link/link_messages.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {

const char* const TeleoperationFollowerNode::kHelp =
    "teleoperation_follower: the rig's end of a network between haptic bridge and rig.\n"
    "In: /link/rig/received /needle/measured_cp /controller/injection_state and /cell/predicted_cf,\n"
    "/force_sensor/measured_cf or both.\n"
    "Out: /link/rig/sent /teleop/servo_cp.\n"
    "Parameters: ~rate (Hz), ~timeouts/... (s), ~force_source, ~measured_share, ~link/...; see config/link.yaml.\n";

TeleoperationFollowerNode::Parameters TeleoperationFollowerNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  parameters.link.scheme = "wave";
  ConfigReader reader = parameterReader(private_node);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  ConfigReader timeouts = reader.section("timeouts");
  timeouts.number("needle", parameters.needle_timeout, Range::positive());
  timeouts.number("predicted", parameters.predicted_timeout, Range::positive());
  timeouts.number("measured", parameters.measured_timeout, Range::positive());
  timeouts.number("controller", parameters.controller_timeout, Range::nonNegative());
  parameters.force = ForceSourceConfig::read(reader);
  parameters.link = LinkConfig::read(reader.section("link"));
  reader.finish();
  return parameters;
}

TeleoperationFollowerNode::TeleoperationFollowerNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      model_(parameters_.link),
      cycle_(node, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kPreviousTick,
                                                       parameters_.needle_timeout)),
      predicted_(forceInput(parameters_.force.usesPredicted(), "predicted", parameters_.predicted_timeout)),
      measured_(forceInput(parameters_.force.usesMeasured(), "measured", parameters_.measured_timeout)),
      sent_(cycle_.output<cell_microinjection::LinkPacket>("link/rig/sent")),
      target_(cycle_.output<geometry_msgs::PoseStamped>("teleop/servo_cp")) {
  cycle_
      .input<cell_microinjection::LinkPacket>("link/rig/received", InputPhase::kPreviousTick,
                                              std::numeric_limits<double>::infinity())
      .onMessage([this](const auto& message, const ros::Time&) {
        if (isPlausible("link/rig/received", message)) model_.receive(toPacket(message));
      });
  if (parameters_.controller_timeout > 0) {
    controller_ = &cycle_.input<cell_microinjection::InjectionStatus>(
        "controller/injection_state", InputPhase::kPreviousTick, parameters_.controller_timeout);
  }
  cycle_.diagnostics().add("link", [this](auto& status) { report(status); });
}

Input<geometry_msgs::WrenchStamped>* TeleoperationFollowerNode::forceInput(bool used, const std::string& source,
                                                                           double timeout) {
  if (!used) return nullptr;
  return &cycle_.input<geometry_msgs::WrenchStamped>(forceTopic(source), InputPhase::kPreviousTick, timeout);
}

void TeleoperationFollowerNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) { step(tick); });
}

void TeleoperationFollowerNode::step(const Cycle::Tick& tick) {
  LinkFollower::Input input;
  input.controller = !controller_ || controller_->get(tick.now);
  if (const auto needle = validPose(needle_.get(tick.now))) {
    input.needle = needle->translation();
    TipForces forces;
    forces.predicted = validForce(predicted_ ? predicted_->get(tick.now) : nullptr, needle->linear());
    forces.measured = validForce(measured_ ? measured_->get(tick.now) : nullptr, needle->linear());
    input.force = chooseForce(parameters_.force, forces);
  }
  const auto target = model_.step(input, tick.dt);
  cell_microinjection::LinkPacket message = toMessage(model_.packet());
  message.header.stamp = tick.now;
  sent_.publish(message);
  if (target) {
    target_.publish(toPose(*target, tick.now, kWorldFrame));
  } else {
    target_.publishInvalid(toPose(Eigen::Vector3d::Zero(), tick.now, kWorldFrame));
  }
}

void TeleoperationFollowerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const bool good = model_.holdReason().empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? "the needle follows" : "needle held: " + model_.holdReason());
  status.add("age of the hand's packet (s)", model_.packetAge());
  status.add("energy margin of the received wave (J)", model_.margin());
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::TeleoperationFollowerNode>(argc, argv, "teleoperation_follower");
}
