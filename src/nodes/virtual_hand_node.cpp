#include "nodes/virtual_hand_node.h"

#include <algorithm>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kGoPeriod = 0.1;      // s
constexpr char kCommand[] = "inject";  ///< the phase that is also a command to the controller

}  // namespace

const char* const VirtualHandNode::kHelp =
    "virtual_hand: a virtual haptic device in a virtual hand that follows a recorded motion\n"
    "from the moment at which the needle follows it.\n"
    "In: /haptic/servo_cf /haptic/loop_state. Out: /haptic/measured_cp /haptic/clutch /virtual_hand/phase\n"
    "/controller/state_command (inject).\n";

VirtualHandNode::Parameters VirtualHandNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("motion", parameters.motion, ConfigReader::kRequired);
  reader.number("start_delay", parameters.start_delay, Range::nonNegative());
  reader.boolean("wait_for_go", parameters.wait_for_go);
  reader.text("recorder", parameters.recorder);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("force_timeout", parameters.force_timeout, Range::positive());
  parameters.hand = VirtualHandConfig::read(reader);
  reader.finish();
  return parameters;
}

VirtualHandNode::VirtualHandNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      motion_(HandMotion::load(parameters_.motion)),
      hand_(parameters_.hand, motion_.at(0).position),
      cycle_(bus, parameters_.rate),
      force_(cycle_.input<geometry_msgs::WrenchStamped>("haptic/servo_cf", InputPhase::kSampled,
                                                        parameters_.force_timeout)),
      position_(cycle_.output<geometry_msgs::PoseStamped>("haptic/measured_cp")),
      clutch_(cycle_.output<sensor_msgs::Joy>("haptic/clutch", true)),
      phase_(cycle_.output<cell_microinjection::StringStamped>("virtual_hand/phase", true)),
      command_output_(cycle_.output<cell_microinjection::StringStamped>("controller/state_command")),
      go_(!parameters_.wait_for_go) {
  force_.one_sender = false;  // the watchdog sends zero force beside the bridge
  loop_ = bus.subscribe<cell_microinjection::LoopState>("haptic/loop_state", 1, [this](const auto& delivery) {
    followed_ = followed_ || delivery.message->follows;
    hold_reason_ = delivery.message->hold_reason;
  });
  cycle_.diagnostics().add("motion", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

bool VirtualHandNode::mayMove() {
  const Bus& bus = cycle_.bus();
  if (go_ || secondsBetween(asked_, bus.steady()) < kGoPeriod) return go_;
  go_ = bus.parameter("/session/go").as<bool>(false);
  asked_ = bus.steady();
  return go_;
}

/// The record of a session that starts slowly would lack the motion's beginning.
bool VirtualHandNode::isHeard() {
  heard_ = heard_ || parameters_.recorder.empty() || position_.publisher.isSubscribedBy(parameters_.recorder);
  return heard_;
}

void VirtualHandNode::step(const Cycle::Tick& tick) {
  if (!mayMove()) return;
  if (followed_ && isHeard()) elapsed_ += tick.dt;
  const double time = std::max(0.0, elapsed_ - parameters_.start_delay);
  const HandMotion::Sample intended = motion_.at(time);
  const auto force = finiteForce(force_.get(tick.now));
  hand_.step(intended.position, force.value_or(Eigen::Vector3d::Zero()), tick.dt);
  position_.publish(toPose(hand_.position(), tick.now, kHapticFrame));
  publishClutch(tick.now, followed_ && intended.clutch);
  publishPhase(tick.now, time >= motion_.duration() ? "done" : intended.phase);
}

void VirtualHandNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (!go_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "waits for the parameter /session/go");
  } else if (!followed_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "waits until the needle follows: " + hold_reason_);
  } else if (!heard_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "waits until " + parameters_.recorder + " listens");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, "moves: " + phase_published_);
  }
}

void VirtualHandNode::publishClutch(const ros::Time& now, bool pressed) {
  if (clutch_published_ == pressed) return;
  sensor_msgs::Joy message;
  message.header.stamp = now;
  message.buttons = {pressed ? 1 : 0};
  clutch_.publish(message);
  clutch_published_ = pressed;
}

void VirtualHandNode::publishPhase(const ros::Time& now, const std::string& phase) {
  if (phase_published_ == phase) return;
  cell_microinjection::StringStamped message;
  message.header.stamp = now;
  message.string = phase;
  phase_.publish(message);
  if (phase == kCommand) command_output_.publish(message);
  phase_published_ = phase;
}

}  // namespace microinjection
