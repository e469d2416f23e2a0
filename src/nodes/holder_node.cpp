#include "nodes/holder_node.h"

#include <cmath>

#include "base/errors.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr char kHolderCommandTopic[] = "holder/state_command";
constexpr double kLargestInflow = 1e-6;  // m^3/s, of a seal; a thousand oocytes are 1e-10 m^3

}  // namespace

const char* const HolderNode::kHelp =
    "holder: the pressure line of the holding pipette, simulated or on a serial line. It keeps its pressure, whatever "
    "fails.\n"
    "In: /holder/set_pressure /holder/state_command (enable, disable, pause, resume) /cell/seal. Out: /holder/state\n"
    "/holder/operating_state. Services: ~reset.\n";

HolderNode::Parameters HolderNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(20, 5000));
  reader.number("command_timeout", parameters.command_timeout, Range::positive());
  reader.number("commander_timeout", parameters.commander_timeout, Range::positive());
  reader.boolean("auto_enable", parameters.auto_enable);
  reader.boolean("sealed", parameters.sealed);
  parameters.model = InjectorModelConfig::read(reader);
  ConfigReader line = reader.section("line");
  parameters.line = PressureLineConfig::read(line);
  parameters.line.rise_time = parameters.model.rise_time;
  parameters.device = PressureDevice::read(reader);
  InjectorProtocol& protocol = parameters.device.protocol;
  if (parameters.device.isSerial() && protocol.balance.empty())
    reader.error("serial/balance", "is missing: a holder needs the lines that set its pressure");
  // There are no pulses, and nothing here may end a pressure.
  protocol.timed = false;
  protocol.stop.clear();
  reader.finish();
  return parameters;
}

HolderNode::HolderNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      cycle_(bus, parameters_.rate),
      line_(parameters_.line, parameters_.model.pipette, parameters_.model.balance),
      state_(cycle_.output<cell_microinjection::HolderState>("holder/state")),
      operating_state_(bus.advertise<cell_microinjection::OperatingState>("holder/operating_state", 10, true)),
      repeated_(bus, kHolderCommandTopic),
      commanded_(parameters_.auto_enable ? OperatingState::kEnabled : OperatingState::kDisabled),
      target_(parameters_.model.balance),
      log_(bus) {
  if (parameters_.device.isSerial()) {
    device_ = std::make_unique<SerialInjector>(parameters_.device.makeWire(bus), parameters_.device.protocol,
                                               parameters_.model, SerialInjector::Start::kKeep);
  }
  MouthSeal seal;
  if (!parameters_.sealed) seal.resistance = 0;
  line_.setSeal(seal);
  subscribe();
  cycle_.diagnostics().add("pressure", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void HolderNode::subscribe() {
  using cell_microinjection::HoldingSeal;
  using cell_microinjection::StringStamped;
  using sensor_msgs::FluidPressure;
  Bus& bus = cycle_.bus();
  subscriptions_ = {
      subscribeGuarded<FluidPressure>(
          bus, "holder/set_pressure", 100,
          [this](const FluidPressure& message, const std::string& sender) { onPressure(message, sender); }),
      subscribeCommand<StringStamped>(
          bus, kHolderCommandTopic, [this](const auto& message, const auto& source) { onState(message, source); },
          StampRule::kAny),
      subscribeMeasured<HoldingSeal>(bus, "cell/seal", 100,
                                     [this](const HoldingSeal& message, const std::string&) { onSeal(message); })};
  reset_ = bus.advertiseService<std_srvs::Trigger>(
      "~reset", [this](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        if (device_) device_->reset();
        line_.reset();
        log_.addResult("reset", "");
        response.success = fault().empty();
        response.message = fault();
        return true;
      });
}

void HolderNode::onPressure(const sensor_msgs::FluidPressure& message, const std::string& sender) {
  log_.addResult("set_pressure", set(message, sender));
}

/// Returns why it is refused; empty: it is followed.
std::string HolderNode::set(const sensor_msgs::FluidPressure& message, const std::string& sender) {
  const ros::Time now = cycle_.bus().now();
  if (cycle_.masterLost()) return "the ROS master is lost";
  std::string refusal = pressureStampError(message.header, now, parameters_.command_timeout);
  if (refusal.empty()) refusal = parameters_.model.limits.checkPressure("pressure", message.fluid_pressure);
  if (!refusal.empty()) return refusal;
  if (state() != OperatingState::kEnabled) return std::string("state is ") + toText(state());
  if (!authority_.authorize(sender, now.toSec())) {
    ROS_ERROR_STREAM(fault());
    return fault();
  }
  if (device_) {
    refusal = device_->setBalance(message.fluid_pressure);
    if (!refusal.empty()) return refusal;
  } else {
    line_.setTarget(message.fluid_pressure);
  }
  target_ = message.fluid_pressure;
  streams_ = sender == commander_ && !commanded_at_.isZero() &&
             secondsBetween(commanded_at_, now) <= parameters_.commander_timeout;
  commander_ = sender;
  commanded_at_ = now;
  kept_.clear();
  return "";
}

void HolderNode::onState(const cell_microinjection::StringStamped& message, const CommandSource& source) {
  log_.addResult("state_command " + message.string, executeState(message, source));
  publishOperatingState(cycle_.bus().now(), true);
}

std::string HolderNode::executeState(const cell_microinjection::StringStamped& message, const CommandSource& source) {
  const bool old = repeated_.mayBe(source);
  const auto command = stateCommandOf(message.string);
  if (!command || *command == StateCommand::kHome || *command == StateCommand::kUnhome)
    return "\"" + message.string + "\" is no command here; allowed: enable, disable, pause, resume";
  const ros::Time now = cycle_.bus().now();
  if (*command == StateCommand::kEnable || *command == StateCommand::kResume) {
    const double age = source.unstamped ? 0 : secondsBetween(message.header.stamp, now);
    if (age > kOldestCommand) return "it is stale";
    if (isAhead(message.header.stamp, now)) return "its stamp is ahead";
    if (old) return std::string(kUnstampedLatched) + "; send it again";
  }
  const OperatingState before = state();
  const auto next = after(before, *command);
  if (!next) return refusalOf(before, *command);
  if (before == OperatingState::kFault) {
    authority_.clear();
    if (device_) device_->reset();  // a pressure that the device has not confirmed is sent anew
  }
  commanded_ = *next;
  streams_ = false;
  kept_.clear();
  return "";
}

void HolderNode::onSeal(const cell_microinjection::HoldingSeal& message) {
  const bool valid = message.resistance >= 0 && std::abs(message.inflow) <= kLargestInflow;
  if (!valid)
    return cycle_.bus().refusals().add("cell/seal", "its resistance is not at or above 0, or its inflow not finite");
  line_.setSeal({message.resistance, message.inflow});
}

OperatingState HolderNode::state() const { return fault().empty() ? commanded_ : OperatingState::kFault; }

std::string HolderNode::fault() const {
  if (!authority_.fault().empty()) return authority_.fault() + "; the pressure is kept; allowed after enable";
  return device_ ? device_->fault() : "";
}

/// A node that sent set-points again and again, and does not any more, may have died in the middle of something.
void HolderNode::watchCommander(const ros::Time& now) {
  const double age = secondsBetween(commanded_at_, now);
  const bool silent = commanded_at_.isZero() || std::abs(age) > parameters_.commander_timeout;
  authority_.step(now.toSec(), !silent);
  if (!silent || commander_.empty()) return;
  if (streams_) {
    kept_ = "the pressure is kept: its commander " + commander_ + " is silent";
    ROS_WARN_STREAM(kept_);
  }
  streams_ = false;
  commander_.clear();
}

void HolderNode::step(const Cycle::Tick& tick) {
  watchCommander(tick.now);
  if (device_) {
    device_->step(tick.now.toSec());
    if (device_->pressureKnown()) line_.setSource(device_->reading().pressure);
  }
  line_.step(tick.now.toSec());
  publish(tick.now);
  publishOperatingState(tick.now, false);
}

void HolderNode::publish(const ros::Time& now) {
  const PressureLineReading& reading = line_.reading();
  cell_microinjection::HolderState message;
  message.header.stamp = now;
  message.pressure = reading.mouth;
  message.line_pressure = reading.pipette;
  message.source_pressure = reading.source;
  message.target = target_;
  message.flow = reading.flow;
  message.volume = reading.volume;
  message.state = toText(state());
  message.commander = commander_;
  message.kept = kept_;
  message.fault = fault();
  message.refusal = log_.refusal();
  known() ? state_.publish(message) : state_.publishInvalid(message);
}

void HolderNode::publishOperatingState(const ros::Time& now, bool reply) {
  cell_microinjection::OperatingState message;
  message.header.stamp = now;
  message.state = toText(state());
  message.is_homed = true;
  if (!reply && message.state == published_state_) return;
  if (message.state != published_state_) ROS_INFO_STREAM(message.state << (fault().empty() ? "" : ": ") << fault());
  published_state_ = message.state;
  operating_state_.publish(message);
}

void HolderNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  if (!fault().empty()) {
    status.summary(DiagnosticStatus::ERROR, fault());
  } else if (state() != OperatingState::kEnabled) {
    status.summary(DiagnosticStatus::WARN, std::string("the holder is ") + toText(state()) + ": its pressure is kept");
  } else if (!kept_.empty()) {
    status.summary(DiagnosticStatus::WARN, kept_);
  } else if (!log_.refusal().empty()) {
    status.summary(DiagnosticStatus::WARN, log_.refusal());
  } else if (!known()) {
    status.summary(DiagnosticStatus::WARN, "the holder's pressure is not known: its device was not told one yet");
  } else {
    status.summary(DiagnosticStatus::OK, "holds");
  }
  status.add("pressure at the mouth", line_.reading().mouth);
  status.add("pressure at the source", line_.reading().source);
  status.add("commands refused", log_.refused());
}

}  // namespace microinjection
