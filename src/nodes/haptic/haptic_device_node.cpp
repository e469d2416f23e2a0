#include "nodes/haptic/haptic_device_node.h"

#include "cell_microinjection/OperatingState.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kButtonPeriod = 0.02;   // s
constexpr double kSilencePeriod = 0.02;  // s
constexpr int kLastDeviceForces = 5;     // several, since messages can be dropped

sensor_msgs::Joy button(const ros::Time& now, bool pressed) {
  sensor_msgs::Joy message;
  message.header.stamp = now;
  message.buttons = {pressed ? 1 : 0};
  return message;
}

}  // namespace

const char* const HapticDeviceNode::kHelp =
    "haptic_device: connects a haptic device without CRTK topics to the bridge; keyboard_hand: uses the keyboard "
    "of\n"
    "the terminal that it is started in.\n"
    "In: /haptic/servo_cf and the device's own topics. Out: /haptic/measured_cp /haptic/clutch "
    "/haptic/operator_present\n"
    "/controller/state_command, and the device's force.\n"
    "Parameters: ~kind (crtk|omni|geomagic|joy|keyboard|marker, required but for keyboard_hand), ~rate (Hz),\n"
    "~force_timeout (s) and those of the kind; see config/haptic/.\n";

HapticDeviceNode::Parameters::Parameters(ConfigReader& reader, const std::string& default_kind) : kind(default_kind) {
  reader.text("kind", kind, default_kind.empty() ? ConfigReader::kRequired : ConfigReader::kOptional);
  reader.number("rate", rate, Range::closed(50, 5000));
  reader.number("force_timeout", force_timeout, Range::positive());
  if (kind.empty()) reader.finish();  // reports that it is missing
}

HapticDeviceNode::HapticDeviceNode(Bus& bus, const std::string& default_kind)
    : reader_(parameterReader(bus)),
      parameters_(reader_, default_kind),
      kind_(findHapticKind(parameters_.kind)),
      cycle_(bus, parameters_.rate),
      // Rendered on arrival, except where that would make bridge and device trigger each other.
      force_(cycle_.input<geometry_msgs::WrenchStamped>(
          "haptic/servo_cf", kind_.paced ? InputPhase::kWakes : InputPhase::kSampled, parameters_.force_timeout)),
      position_(cycle_.output<geometry_msgs::PoseStamped>("haptic/measured_cp")),
      clutch_(cycle_.output<sensor_msgs::Joy>("haptic/clutch")),
      operator_present_(cycle_.output<sensor_msgs::Joy>("haptic/operator_present")),
      commands_(bus.advertise<cell_microinjection::StringStamped>("controller/state_command", 10)),
      adapter_(kind_.make(cycle_, reader_)) {
  force_.one_sender = false;  // the watchdog sends zero force beside the bridge
  using cell_microinjection::OperatingState;
  controller_ = subscribeGuarded<OperatingState>(
      bus, "controller/operating_state", 10,
      [this](const OperatingState& message, const std::string&) { paused_ = message.state == "PAUSED"; },
      StampRule::kAny);
  cycle_.diagnostics().add("device", [this](auto& status) { report(status); });
  bus.onEnd([this] { publishZeroForce(); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void HapticDeviceNode::step(const Cycle::Tick& tick) {
  if (adapter_->wantsToEnd()) return cycle_.bus().stop();
  const std::optional<HandReading> hand = adapter_->read(tick);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  adapter_->render(hand ? finiteForce(force_.get(tick.now)).value_or(zero) : zero, tick);
  if (!hand) {
    publishNoMessage(tick.now);
  } else if (!last_ || hand->stamp != last_->stamp) {
    position_.publish(toPose(hand->position, hand->stamp, kHapticFrame));
  }
  publishButtons(tick.now, hand && hand->clutch, hand && hand->operator_present);
  publishCommands(tick.now);
  last_ = hand;
}

/// Not in every step: the message triggers the bridge, whose force triggers this node, and both
/// would run at full speed.
void HapticDeviceNode::publishNoMessage(const ros::Time& now) {
  if (!last_ && !isDue(silence_published_, now, kSilencePeriod)) return;
  silence_published_ = now;
  position_.publishInvalid(toPose(Eigen::Vector3d::Zero(), now, kHapticFrame));
}

void HapticDeviceNode::publishButtons(const ros::Time& now, bool clutch, bool operator_present) {
  const bool changed = !last_ || last_->clutch != clutch || last_->operator_present != operator_present;
  if (!changed && !isDue(buttons_published_, now, kButtonPeriod)) return;
  buttons_published_ = now;
  clutch_.publish(button(now, clutch));
  operator_present_.publish(button(now, operator_present));
}

void HapticDeviceNode::publishCommands(const ros::Time& now) {
  for (const std::string& command : adapter_->takeCommands()) {
    cell_microinjection::StringStamped message;
    message.header.stamp = now;
    // The operator has one button for both; CRTK's enable does not end PAUSED.
    message.string = command == "enable" && paused_ ? "resume" : command;
    commands_.publish(message);
  }
}

void HapticDeviceNode::publishZeroForce() {
  for (int i = 0; i < kLastDeviceForces; ++i) {
    const ros::Time now = cycle_.bus().now();
    adapter_->render(Eigen::Vector3d::Zero(), {now, cycle_.period()});
    position_.publishInvalid(toPose(Eigen::Vector3d::Zero(), now, kHapticFrame));
    operator_present_.publish(button(now, false));
    cycle_.bus().pause(0.01);
  }
}

void HapticDeviceNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string reason = adapter_->invalidReason();
  status.summary(last_ ? diagnostic_msgs::DiagnosticStatus::OK : diagnostic_msgs::DiagnosticStatus::WARN,
                 last_            ? "the hand's position is valid"
                 : reason.empty() ? "the device is stale: zero force"
                                  : "the hand is not followed: " + reason);
  status.add("kind", kind_.name);
  if (last_) status.add("operator", last_->operator_present ? "present" : "not present");
}

}  // namespace microinjection
