#include "nodes/haptic_bridge_node.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "nodes/haptic/local_peer.h"
#include "nodes/link/remote_peer.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr int kLastHandForces = 5;       // several, since messages can be dropped
constexpr double kUnchangedSpeed = 0.2;  // s, for which one pose may set a speed

/// A time-out (s) of 0 in the parameters means for ever.
double orForEver(double timeout) { return timeout > 0 ? timeout : std::numeric_limits<double>::infinity(); }

/// Some drivers report a finished tap as 2 or 3 (cisst's CLICKED, DOUBLE_CLICKED): not held down.
bool heldDown(const sensor_msgs::Joy& joy) { return joy.buttons[0] == 1; }

}  // namespace

const char* const HapticBridgeNode::kHelp =
    "haptic_bridge: couples a haptic device to the needle, position forward and force back.\n"
    "In: /haptic/measured_cp /haptic/clutch /haptic/operator_present /needle/measured_cp\n"
    "/controller/injection_state, and /cell/predicted_cf, /force_sensor/measured_cf or both.\n"
    "Out: /haptic/servo_cf /haptic/loop_state /teleop/servo_cp.\n"
    "Service: ~calibrate_axes.\n"
    "With link/scheme wave, /link/hand/received and /link/hand/sent replace the rig's topics;\n"
    "config/link.yaml has the keys of ~link.\n";

HapticBridgeNode::Timeouts HapticBridgeNode::Timeouts::read(ConfigReader reader) {
  Timeouts timeouts;
  reader.number("hand", timeouts.hand, Range::positive());
  reader.number("hand_unchanged", timeouts.hand_unchanged, Range::nonNegative());
  reader.number("clutch", timeouts.clutch, Range::nonNegative());
  reader.number("operator_present", timeouts.operator_present, Range::nonNegative());
  timeouts.rig.read(reader);
  return timeouts;
}

HapticBridgeNode::Parameters HapticBridgeNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.boolean("force_feedback", parameters.force_feedback);
  reader.path("axes_file", parameters.axes_file);
  reader.boolean("quiet_sensor", parameters.quiet_sensor);
  parameters.timeouts = Timeouts::read(reader.section("timeouts"));
  parameters.model = HapticBridgeConfig::read(reader);
  parameters.link = LinkConfig::read(reader.section("link"));
  if (parameters.link.used()) parameters.model = parameters.model.beforeLink();
  reader.finish();
  return parameters;
}

HapticBridgeNode::HapticBridgeNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      model_(parameters_.model),
      cycle_(bus, parameters_.rate),
      hand_(cycle_.input<geometry_msgs::PoseStamped>("haptic/measured_cp", InputPhase::kDrives,
                                                     parameters_.timeouts.hand)),
      clutch_(cycle_.input<sensor_msgs::Joy>("haptic/clutch", InputPhase::kSampled,
                                             orForEver(parameters_.timeouts.clutch))),
      hand_force_(cycle_.output<geometry_msgs::WrenchStamped>("haptic/servo_cf")),
      trace_(cycle_.output<sensor_msgs::TimeReference>("haptic/force_trace")),
      loop_state_(bus, "haptic/loop_state"),
      receiver_(cycle_, hand_force_.publisher, parameters_.force_feedback),
      hand_poses_(longestUnchanged()),
      axes_(cycle_, parameters_.model.frame.device_axes, parameters_.model.motion.mode == "rate",
            parameters_.axes_file) {
  if (parameters_.model.require_operator) {
    operator_present_ = &cycle_.input<sensor_msgs::Joy>("haptic/operator_present", InputPhase::kSampled,
                                                        orForEver(parameters_.timeouts.operator_present));
  }
  receiver_.monitor(hand_);
  hand_.onMessage([this](const geometry_msgs::PoseStamped& hand, const ros::Time& now) { watch(hand, now); });
  const HapticBridgeConfig& model = parameters_.model;
  if (parameters_.link.used()) {
    rig_ = std::make_unique<RemotePeer>(cycle_, parameters_.link, model);
  } else {
    rig_ = std::make_unique<LocalPeer>(cycle_, parameters_.timeouts.rig, model.force, parameters_.quiet_sensor, trace_);
  }
  cycle_.diagnostics().add("loop", [this](auto& status) { report(status); });
  bus.onEnd([this] { publishZeroForce(); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

/// A pose that does not change although it sets a speed leads the needle away.
double HapticBridgeNode::longestUnchanged() const {
  const double longest = orForEver(parameters_.timeouts.hand_unchanged);
  const bool sets_speed = parameters_.model.motion.mode == "rate" && std::isfinite(longest);
  return sets_speed ? std::min(longest, kUnchangedSpeed) : longest;
}

void HapticBridgeNode::watch(const geometry_msgs::PoseStamped& hand, const ros::Time& now) {
  const double dt = watched_.isZero() ? 0 : std::max(0.0, secondsBetween(watched_, now));
  watched_ = now;
  if (hand.header.stamp.isZero()) return hand_.repeats.clear();
  const Eigen::Vector3d position = toVector(hand.pose.position);
  // A device that leads nothing may lie on the table, and one that sets a speed may rest in its dead zone.
  const bool sets_speed = parameters_.model.motion.mode == "rate";
  const bool leads = output_.state == Engagement::State::kFollow && !(sets_speed && output_.needle == led_to_);
  led_to_ = output_.needle;
  const bool repeats = hand_poses_.step(position, leads ? dt : 0);
  hand_.repeats = repeats ? "one pose, which the tremor of a hand must change" : "";
  const double step = (position - toVector(last_hand_.pose.position)).norm();
  const double passed = secondsBetween(last_hand_.header.stamp, hand.header.stamp);
  hand_leaps_ = hand_leaps_ || step > parameters_.model.engagement.longestStep(passed);
  last_hand_ = hand;
}

/// Ends with zero force, for a driver that holds the last one.
void HapticBridgeNode::publishZeroForce() {
  for (int i = 0; i < kLastHandForces; ++i) {
    const ros::Time now = cycle_.bus().now();
    hand_force_.publish(toWrench(Eigen::Vector3d::Zero(), now, hand_frame_));
    rig_->withdraw(now);
    cycle_.bus().pause(0.01);
  }
}

bool HapticBridgeNode::clutchPressed(const ros::Time& now) const {
  if (clutch_.received.isZero()) return false;  // a device without a clutch
  const sensor_msgs::Joy* joy = clutch_.get(now);
  return !joy || joy->buttons.empty() || heldDown(*joy);  // an invalid one counts as pressed
}

bool HapticBridgeNode::operatorPresent(const ros::Time& now) const {
  const sensor_msgs::Joy* joy = operator_present_ ? operator_present_->get(now) : nullptr;
  return joy && !joy->buttons.empty() && heldDown(*joy);
}

/// The needle does not follow when the axes change, so that the bridge may start anew.
void HapticBridgeNode::takeAxes() {
  if (axes_.axes() == parameters_.model.frame.device_axes) return;
  parameters_.model.frame.device_axes = axes_.axes();
  model_ = HapticBridge(parameters_.model);
}

void HapticBridgeNode::step(const Cycle::Tick& tick) {
  takeAxes();
  const auto* hand = hand_.get(tick.now);
  HapticBridge::Input input;
  if (hand) hand_frame_ = hand->header.frame_id;
  // A stale device that publishes only changes may have missed the last one.
  if (!hand && operator_present_ && parameters_.timeouts.operator_present <= 0) operator_present_->invalidate();
  // After two devices the operator presses anew, whichever is left.
  if (operator_present_ && !(operator_present_->rivals(tick.now) + clutch_.rivals(tick.now)).empty())
    operator_present_->invalidate();
  if (hand) input.hand = validPosition(hand, hand->header.frame_id, kLargestHandDistance);
  rig_->read(input, tick);
  input.hand_leaps = std::exchange(hand_leaps_, false);
  input.clutch = clutchPressed(tick.now);
  input.operator_present = operatorPresent(tick.now);
  if (!receiver_.isConnected()) input.no_force_reason = receiver_.reason();
  input.no_motion_reason = axes_.holdReason();
  output_ = model_.step(input, tick.dt);
  axes_.observe(input.hand, output_.state == Engagement::State::kFollow);
  hand_force_.publish(toWrench(output_.hand_force, tick.now, hand_frame_));
  rig_->send(output_.needle, hand ? hand->header.stamp : tick.now, tick);
  loop_state_.step(holdReason(), tick.now);
}

std::string HapticBridgeNode::holdReason() const {
  const std::string of_rig = output_.hold_reason.empty() ? "" : rig_->holdReason();
  return of_rig.empty() ? output_.hold_reason : of_rig;
}

void HapticBridgeNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string reason = holdReason();
  status.summary(reason.empty() ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 reason.empty() ? "the loop is closed" : "needle held, zero force: " + reason);
  status.add("state", Engagement::name(output_.state));
  status.add("force source", parameters_.model.force.source);
  status.add("tremor filter's delay (s)", model_.delay());
  status.add("observed energy (J)", model_.observedEnergy());
  rig_->report(status);
  axes_.report(status);
  status.add("passivity controller acts", model_.passivityActing() ? "yes" : "no");
}

}  // namespace microinjection
