#include "nodes/haptic_bridge_node.h"

#include <limits>

#include "nodes/link/link_messages.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/ending.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/latency_meter.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {
namespace {

constexpr int kLastForces = 5;  // several, since messages can be dropped

/// A time-out (s) of 0 in the parameters means for ever.
double orForEver(double timeout) { return timeout > 0 ? timeout : std::numeric_limits<double>::infinity(); }

/// Some drivers report a finished tap as 2 or 3 (cisst's CLICKED, DOUBLE_CLICKED): not held down.
bool heldDown(const sensor_msgs::Joy& joy) { return joy.buttons[0] == 1; }

}  // namespace

const char* const HapticBridgeNode::kHelp =
    "haptic_bridge: couples a haptic device to the needle, position forward and force back.\n"
    "In: /haptic/measured_cp /haptic/clutch /haptic/operator_present /needle/measured_cp and /cell/predicted_cf, "
    "/force_sensor/measured_cf or "
    "both; with ~link/scheme wave instead of these three /link/hand/received.\n"
    "Out: /haptic/servo_cf /teleop/servo_cp; with a link instead of the latter /link/hand/sent.\n"
    "Parameters: ~rate (Hz), ~timeouts/... (s), ~position_scale, ~force_gain, ~force_source "
    "(predicted|measured|blend),\n"
    "~mode (position|rate), ~device_axes and many more; see config/haptic_bridge.yaml.\n";

HapticBridgeNode::Timeouts HapticBridgeNode::Timeouts::read(ConfigReader reader) {
  Timeouts timeouts;
  reader.number("hand", timeouts.hand, Range::positive());
  reader.number("clutch", timeouts.clutch, Range::nonNegative());
  reader.number("operator_present", timeouts.operator_present, Range::nonNegative());
  reader.number("needle", timeouts.needle, Range::positive());
  reader.number("predicted", timeouts.predicted, Range::positive());
  reader.number("measured", timeouts.measured, Range::positive());
  reader.number("controller", timeouts.controller, Range::nonNegative());
  return timeouts;
}

HapticBridgeNode::Parameters HapticBridgeNode::Parameters::read(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.boolean("force_feedback", parameters.force_feedback);
  parameters.timeouts = Timeouts::read(reader.section("timeouts"));
  parameters.model = HapticBridgeConfig::read(reader);
  parameters.link = LinkConfig::read(reader.section("link"));
  if (parameters.link.used()) parameters.model = parameters.model.beforeLink();
  reader.finish();
  return parameters;
}

HapticBridgeNode::HapticBridgeNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(Parameters::read(private_node)),
      model_(parameters_.model),
      cycle_(node, parameters_.rate),
      hand_(cycle_.input<geometry_msgs::PoseStamped>("haptic/measured_cp", InputPhase::kThisTick,
                                                     parameters_.timeouts.hand)),
      clutch_(cycle_.input<sensor_msgs::Joy>("haptic/clutch", InputPhase::kPreviousTick,
                                             orForEver(parameters_.timeouts.clutch))),
      hand_force_(cycle_.output<geometry_msgs::WrenchStamped>("haptic/servo_cf")),
      trace_(cycle_.output<sensor_msgs::TimeReference>("haptic/force_trace")),
      receiver_(hand_force_.publisher, parameters_.force_feedback && !cycle_.lockstep()) {
  if (parameters_.model.require_operator) {
    operator_present_ = &cycle_.input<sensor_msgs::Joy>("haptic/operator_present", InputPhase::kPreviousTick,
                                                        orForEver(parameters_.timeouts.operator_present));
  }
  receiver_.monitor(hand_);
  parameters_.link.used() ? connectLink() : connectRig();
  cycle_.diagnostics().add("loop", [this](auto& status) { report(status); });
}

void HapticBridgeNode::connectRig() {
  needle_ = &cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kPreviousTick,
                                                      parameters_.timeouts.needle);
  predicted_ = forceInput(parameters_.model.force.usesPredicted(), "predicted", parameters_.timeouts.predicted);
  measured_ = forceInput(parameters_.model.force.usesMeasured(), "measured", parameters_.timeouts.measured);
  target_ = &cycle_.output<geometry_msgs::PoseStamped>("teleop/servo_cp");
  if (parameters_.timeouts.controller <= 0) return;
  controller_ = &cycle_.input<cell_microinjection::InjectionStatus>(
      "controller/injection_state", InputPhase::kPreviousTick, parameters_.timeouts.controller);
}

void HapticBridgeNode::connectLink() {
  // A restarted bridge must continue the count of epochs: wall time, also in lock step.
  link_ = std::make_unique<LinkLeader>(parameters_.link, parameters_.model.motion.position_scale,
                                       parameters_.model.force_gain, ros::WallTime::now().toNSec());
  cycle_
      .input<cell_microinjection::LinkPacket>("link/hand/received", InputPhase::kPreviousTick,
                                              std::numeric_limits<double>::infinity())
      .onMessage([this](const auto& message, const ros::Time&) {
        if (isPlausible("link/hand/received", message)) link_->receive(toPacket(message));
      });
  link_sent_ = &cycle_.output<cell_microinjection::LinkPacket>("link/hand/sent");
}

Input<geometry_msgs::WrenchStamped>* HapticBridgeNode::forceInput(bool used, const std::string& source,
                                                                  double timeout) {
  if (!used) return nullptr;
  return &cycle_.input<geometry_msgs::WrenchStamped>(forceTopic(source), InputPhase::kPreviousTick, timeout);
}

void HapticBridgeNode::run() {
  cycle_.run([this](const Cycle::Tick& tick) {
    if (shutdownRequested()) {
      cycle_.stop();
    } else {
      step(tick);
    }
  });
  publishZeroForce();
}

/// Ends with zero force, for a driver that holds the last one.
void HapticBridgeNode::publishZeroForce() {
  for (int i = 0; i < kLastForces && ros::ok(); ++i) {
    const ros::Time now = ros::Time::now();
    hand_force_.publish(toWrench(Eigen::Vector3d::Zero(), now, hand_frame_));
    if (target_) target_->publishInvalid(toPose(Eigen::Vector3d::Zero(), now, kWorldFrame));
    ros::WallDuration(0.01).sleep();
  }
}

bool HapticBridgeNode::controllerIsAlive(const ros::Time& now) const { return !controller_ || controller_->get(now); }

bool HapticBridgeNode::clutchPressed(const ros::Time& now) const {
  if (clutch_.received.isZero()) return false;  // a device without a clutch
  const sensor_msgs::Joy* joy = clutch_.get(now);
  return !joy || joy->buttons.empty() || heldDown(*joy);  // an invalid one counts as pressed
}

bool HapticBridgeNode::operatorPresent(const ros::Time& now) const {
  const sensor_msgs::Joy* joy = operator_present_ ? operator_present_->get(now) : nullptr;
  return joy && !joy->buttons.empty() && heldDown(*joy);
}

void HapticBridgeNode::readRig(HapticBridge::Input& input, const Cycle::Tick& tick) {
  if (link_) {
    // The rig has chosen the source.
    const auto force = link_->step(tick.dt);
    input.needle = link_->needle();
    if (force) input.force.predicted = input.force.measured = *force / parameters_.model.force_gain;
    return;
  }
  const auto needle = validPose(needle_->get(tick.now));
  without_controller_ = !controllerIsAlive(tick.now);
  if (!needle || without_controller_) return;
  input.needle = needle->translation();
  input.force.predicted = validForce(predicted_ ? predicted_->get(tick.now) : nullptr, needle->linear());
  input.force.measured = validForce(measured_ ? measured_->get(tick.now) : nullptr, needle->linear());
}

void HapticBridgeNode::sendToRig(const Cycle::Tick& tick) {
  if (link_) {
    link_->setTarget(output_.needle);
    cell_microinjection::LinkPacket message = toMessage(link_->packet());
    message.header.stamp = tick.now;
    link_sent_->publish(message);
  } else if (output_.needle) {
    target_->publish(toPose(*output_.needle, hand_.get(tick.now)->header.stamp, kWorldFrame));
    trace(tick);
  } else {
    target_->publishInvalid(toPose(Eigen::Vector3d::Zero(), tick.now, kWorldFrame));
  }
}

void HapticBridgeNode::trace(const Cycle::Tick& tick) {
  const auto* force = predicted_ ? predicted_->get(tick.now) : measured_->get(tick.now);
  if (isTraced(force->header.stamp)) trace_.publish(toTrace(tick.now, force->header.stamp, "needle"));
}

void HapticBridgeNode::step(const Cycle::Tick& tick) {
  const auto* hand = hand_.get(tick.now);
  HapticBridge::Input input;
  if (hand) hand_frame_ = hand->header.frame_id;
  // A stale device that publishes only changes may have missed the last one.
  if (!hand && operator_present_ && parameters_.timeouts.operator_present <= 0) operator_present_->invalidate();
  if (hand) input.hand = validPosition(hand, hand->header.frame_id, kLargestHandDistance);
  readRig(input, tick);
  input.clutch = clutchPressed(tick.now);
  input.operator_present = operatorPresent(tick.now);
  if (!receiver_.isConnected()) input.no_force_reason = receiver_.reason();
  output_ = model_.step(input, tick.dt);
  hand_force_.publish(toWrench(output_.hand_force, tick.now, hand_frame_));
  sendToRig(tick);
}

void HapticBridgeNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const bool good = output_.hold_reason.empty();
  status.summary(good ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 good                  ? "the loop is closed"
                 : without_controller_ ? "needle held, zero force: the controller is silent"
                                       : "needle held, zero force: " + output_.hold_reason);
  status.add("state", Engagement::name(output_.state));
  status.add("force source", parameters_.model.force.source);
  status.add("tremor filter's delay (s)", model_.delay());
  status.add("observed energy (J)", model_.observedEnergy());
  if (link_) {
    status.add("age of the rig's packet (s)", link_->packetAge());
    status.add("round trip (periods)", link_->roundTrip());
  }
  status.add("passivity controller acts", model_.passivityActing() ? "yes" : "no");
}

}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runNode<HapticBridgeNode>(argc, argv, "haptic_bridge", Priority::kRealTime, ShutdownMode::kInGoodOrder);
}
