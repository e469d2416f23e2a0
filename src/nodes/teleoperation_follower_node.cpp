#include "nodes/teleoperation_follower_node.h"

#include <limits>

#include "nodes/link/link_messages.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {

const char* const TeleoperationFollowerNode::kHelp =
    "teleoperation_follower: the rig's end of a network between haptic bridge and rig.\n"
    "In: /link/rig/received /needle/measured_cp /controller/injection_state and /cell/predicted_cf,\n"
    "/force_sensor/measured_cf or both.\n"
    "Out: /link/rig/sent /link/rig/loop_state /teleop/servo_cp.\n"
    "Beside those below: ~rate, ~timeouts/needle, predicted and measured, ~force_source and ~measured_share, as in\n"
    "config/haptic_bridge.yaml.\n";

TeleoperationFollowerNode::Parameters TeleoperationFollowerNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  parameters.link.scheme = "wave";
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  ConfigReader timeouts = reader.section("timeouts");
  parameters.timeouts.read(timeouts);
  parameters.force = ForceSourceConfig::read(reader);
  reader.boolean("quiet_sensor", parameters.quiet_sensor);
  parameters.link = LinkConfig::read(reader.section("link"));
  reader.finish();
  return parameters;
}

TeleoperationFollowerNode::TeleoperationFollowerNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      model_(parameters_.link),
      cycle_(bus, parameters_.rate),
      rig_(cycle_, parameters_.timeouts, parameters_.force, parameters_.quiet_sensor),
      sent_(cycle_.output<cell_microinjection::LinkPacket>("link/rig/sent")),
      target_(cycle_.output<geometry_msgs::PoseStamped>("teleop/servo_cp")),
      loop_state_(bus, "link/rig/loop_state") {
  cycle_
      .input<cell_microinjection::LinkPacket>("link/rig/received", InputPhase::kSampled,
                                              std::numeric_limits<double>::infinity())
      .onMessage([this](const auto& message, const ros::Time&) {
        if (isPlausible(cycle_.bus(), "link/rig/received", message)) model_.receive(toPacket(message));
      });
  cycle_.diagnostics().add("link", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void TeleoperationFollowerNode::step(const Cycle::Tick& tick) {
  const PeerInputs::Reading rig = rig_.read(tick.now);
  LinkFollower::Input input;
  input.controller = rig.controller;
  input.needle = rig.needle;
  if (rig.needle) input.force = chooseForce(parameters_.force, rig.force);
  const auto target = model_.step(input, tick.dt);
  cell_microinjection::LinkPacket message = toMessage(model_.packet());
  message.header.stamp = tick.now;
  sent_.publish(message);
  if (target) {
    target_.publish(toPose(*target, tick.now, kWorldFrame));
  } else {
    target_.publishInvalid(toPose(Eigen::Vector3d::Zero(), tick.now, kWorldFrame));
  }
  loop_state_.step(model_.holdReason(), tick.now);
}

void TeleoperationFollowerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const bool good = model_.holdReason().empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good ? "the needle follows" : "needle held: " + model_.holdReason());
  status.add("age of the hand's packet (s)", model_.packetAge());
  status.add("energy margin of the received wave (J)", model_.margin());
}

}  // namespace microinjection
