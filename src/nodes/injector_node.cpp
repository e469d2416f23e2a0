#include "nodes/injector_node.h"

#include <utility>
#include <vector>

#include "hardware/injector/serial_injector.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kBoreTimeout = 0.1;  ///< s

}  // namespace

const char* const InjectorNode::kHelp =
    "injector: a pressure injector behind the pipette, simulated or on a serial line.\n"
    "In: /injector/pulse /injector/stop /injector/set_balance, /cell/bore (simulated). Out: /injector/state. Services: "
    "~reset ~clog "
    "(simulated).\n";

InjectorNode::Parameters InjectorNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(20, 5000));
  reader.number("command_timeout", parameters.command_timeout, Range::positive());
  reader.number("pulse_timeout", parameters.pulse_timeout, Range::positive());
  reader.number("clog_factor", parameters.clog_factor, {1, INFINITY, false, true});
  parameters.model = InjectorModelConfig::read(reader);
  reader.number("draw_limit", parameters.model.draw_limit, Range::nonNegative());
  parameters.device = PressureDevice::read(reader);
  const InjectorProtocol& protocol = parameters.device.protocol;
  const std::string refusal = protocol.balance.empty() ? "" : protocol.balanceRefusal(parameters.model.balance);
  if (!refusal.empty()) reader.error("balance", refusal);
  reader.finish();
  return parameters;
}

InjectorNode::InjectorNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      cycle_(bus, parameters_.rate),
      flow_(parameters_.model.pipette),
      state_(cycle_.output<cell_microinjection::InjectorState>("injector/state")),
      log_(bus) {
  makeDevice();
  // The handler receives every command, also several between two steps.
  cycle_.input<cell_microinjection::InjectionPulse>("injector/pulse", InputPhase::kSampled, INFINITY)
      .onMessage([this](const auto& message, const ros::Time&) { onPulse(message); });
  auto& stop = cycle_.input<cell_microinjection::StringStamped>("injector/stop", InputPhase::kSampled, INFINITY);
  stop.stamp_rule = StampRule::kAny;
  stop.onMessage([this](const auto& message, const ros::Time&) { onStop(message); });
  balance_ = subscribeGuarded<sensor_msgs::FluidPressure>(
      bus, "injector/set_balance", 100,
      [this](const sensor_msgs::FluidPressure& message, const std::string&) { onBalance(message); });
  reset_ = bus.advertiseService<std_srvs::Trigger>(
      "~reset", [this](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        device_->reset();
        log_.addResult("reset", "");
        response.success = device_->fault().empty();
        response.message = device_->fault();
        return true;
      });
  cycle_.diagnostics().add("injector", [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void InjectorNode::makeDevice() {
  if (parameters_.device.isSerial()) {
    device_ = std::make_unique<SerialInjector>(parameters_.device.makeWire(cycle_.bus()), parameters_.device.protocol,
                                               parameters_.model);
    return;
  }
  auto model = std::make_unique<InjectorModel>(parameters_.model);
  simulated_ = model.get();  // owned by device_, which outlives the service
  device_ = std::move(model);
  bore_ = &cycle_.input<cell_microinjection::BoreState>("cell/bore", InputPhase::kSampled, kBoreTimeout);
  bore_->optional = true;  // of a scene whose needle has a bore
  clog_ = cycle_.bus().advertiseService<std_srvs::SetBool>(
      "~clog", [this](std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
        clogged_ = request.data;
        simulated_->clog(clogged_ ? parameters_.clog_factor : 1);
        response.success = true;
        return true;
      });
}

std::string InjectorNode::stampError(const std_msgs::Header& header) const {
  return pressureStampError(header, cycle_.bus().now(), parameters_.command_timeout);
}

void InjectorNode::onPulse(const cell_microinjection::InjectionPulse& message) {
  const std::string command = "pulse " + std::to_string(message.id);
  if (message.id == 0) return log_.addResult(command, "its id is 0, which means none");
  const std::string error = stampError(message.header);
  // Of a pulse that is held the next message may be in time.
  if (!error.empty()) return log_.addResult((message.held ? "a message of " : "") + command, error);
  // A refused id counts as used, too: the same message, received again, must not inject later.
  if (!ids_.isNew(message.id)) {
    if (message.id == held_) {
      last_repetition_ = message.header.stamp;
      adjust(message.pressure);
    } else if (!message.held) {
      ++repeated_;
    }
    return;
  }
  const std::string refusal =
      cycle_.masterLost() ? "the ROS master is lost" : device_->pulse({message.id, message.pressure, message.duration});
  log_.addResult(command, refusal);
  if (!message.held || !refusal.empty()) return;
  held_ = message.id;
  held_pressure_ = message.pressure;
  last_repetition_ = message.header.stamp;
}

/// The sender of the held pulse wants another pressure.
void InjectorNode::adjust(double pressure) {
  if (pressure == held_pressure_ || !device_->reading().busy) return;
  held_pressure_ = pressure;  // one that is refused is not asked for again
  log_.addResult("pressure of pulse " + std::to_string(held_), device_->adjust(pressure));
}

void InjectorNode::onStop(const cell_microinjection::StringStamped& message) {
  log_.addResult("stop", device_->stop());
  ROS_INFO_STREAM("stopped: " << message.string);
}

void InjectorNode::onBalance(const sensor_msgs::FluidPressure& message) {
  const std::string error = stampError(message.header);
  log_.addResult("set_balance", error.empty() ? device_->setBalance(message.fluid_pressure) : error);
}

/// Ends a pulse that no node could end any more.
void InjectorNode::endAbandonedPulse(const ros::Time& now) {
  const bool lost = !std::exchange(master_lost_, cycle_.masterLost()) && master_lost_;
  if (!device_->reading().busy) held_ = 0;
  const double age = secondsBetween(last_repetition_, now);  // much below 0: the clock was set back
  const bool silent = held_ != 0 && (age > parameters_.pulse_timeout || age < -parameters_.command_timeout);
  if (!device_->reading().busy || !(lost || silent)) return;
  held_ = 0;
  ROS_WARN_STREAM("the pulse is ended: " << (lost ? "the ROS master is lost" : "its sender is stale"));
  log_.addResult("stop", device_->stop());
}

void InjectorNode::step(const Cycle::Tick& tick) {
  endAbandonedPulse(tick.now);
  if (simulated_) {
    const auto* bore = bore_->get(tick.now);
    simulated_->cover(bore && bore->covered ? std::optional(bore->flow) : std::nullopt);
  }
  device_->step(tick.now.toSec());
  cycle_.bus().setBusy(device_->reading().busy);
  const InjectorReading& reading = device_->reading();
  cell_microinjection::InjectorState state;
  state.header.stamp = tick.now;
  state.pressure = reading.pressure;
  state.rest_pressure = flow_.restPressure();
  state.resistance = simulated_ ? simulated_->resistance() : flow_.resistance();
  state.flow = reading.flow;
  state.volume = reading.volume;
  state.drawn = reading.drawn;
  state.interface = reading.interface;
  state.limited = reading.limited;
  state.busy = reading.busy;
  state.last_id = reading.last_id;
  state.pulses = reading.pulses;
  state.fault = device_->fault();
  state.refusal = log_.refusal();
  state_.publish(state);
}

void InjectorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const InjectorReading& reading = device_->reading();
  if (!device_->fault().empty()) {
    status.summary(DiagnosticStatus::ERROR, device_->fault());
  } else if (clogged_) {
    status.summary(DiagnosticStatus::WARN, "the tip is clogged on request");
  } else if (!log_.refusal().empty()) {
    status.summary(DiagnosticStatus::WARN, log_.refusal());
  } else if (reading.limited) {
    status.summary(DiagnosticStatus::WARN, "draw_limit is reached: nothing more is drawn in");
  } else if (!reading.busy && reading.flow < 0) {
    status.summary(DiagnosticStatus::WARN, "flows back: the balance pressure is too low");
  } else {
    status.summary(DiagnosticStatus::OK, reading.busy ? "injects" : "ready");
  }
  status.add("pulses done", reading.pulses);
  status.add("commands refused", log_.refused());
  status.add("repeated pulses ignored", repeated_);
}

}  // namespace microinjection
