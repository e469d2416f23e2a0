#include "nodes/force_sensor_node.h"

#include <filesystem>
#include <limits>

#include "base/errors.h"
#include "base/paths.h"
#include "nodes/runtime/background_writing.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_liveness.h"
#include "nodes/runtime/frames.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {

namespace {

constexpr char kStatus[] = "sensor";  // on /diagnostics

}  // namespace

const char* const ForceSensorNode::kHelp =
    "force_sensor: a simulated two-axis MEMS sensor at the pipette, voltages on a serial line, or another node's "
    "wrench.\n"
    "In: /cell/predicted_cf, /needle/measured_cp (source simulated) or /force_sensor/device_cf (source topic).\n"
    "Out: /force_sensor/measured_cf (needle_tip: z along, x across) /force_sensor/raw_cf (the sensor's frame).\n"
    "Services: ~tare ~reset ~calibrate.\n";

ForceSensorNode::Parameters ForceSensorNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.choice("source", parameters.source, {"simulated", "serial", "topic"});
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  reader.number("averaging", parameters.averaging, Range::positive());
  reader.text("frame", parameters.frame);
  reader.boolean("quiet", parameters.quiet);
  reader.number("frame_timeout", parameters.frame_timeout, Range::positive());
  reader.path("file", parameters.file);
  // A simulated sensor is another one in each session; a wrench is calibrated where it is measured.
  if (parameters.file.empty() && parameters.source == "serial") parameters.file = userDataFile("force_sensor.yaml");
  ConfigReader simulated = reader.section("simulated");
  parameters.simulated = ForceSensorConfig::read(simulated);
  if (parameters.source == "simulated" && !parameters.quiet && parameters.simulated.mayRepeat(parameters.rate)) {
    reader.error("quiet",
                 "must be true (sensor/quiet of the session): the noise of the simulated sensor is below the "
                 "step of its readings, or its sample_rate below rate, so that it repeats readings");
  }
  // Sections of unused sources may stay in a file; they are read as strictly.
  for (const std::string source : {"serial", "topic"}) {
    if (parameters.source != source && !reader.has(source)) continue;
    ConfigReader section = reader.section(source);
    Eigen::Vector2d overload = parameters.overload;
    section.number("axial_overload", overload[0], Range::positive());
    section.number("lateral_overload", overload[1], Range::positive());
    if (parameters.source == source) parameters.overload = overload;
    if (source == "topic") continue;
    parameters.port = SerialPortConfig::read(section, 115200);
    parameters.voltages = VoltReadingConfig::read(section);
  }
  reader.finish();
  return parameters;
}

ForceSensorNode::ForceSensorNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      cycle_(bus, parameters_.rate),
      source_(makeSource()),
      readout_(source_->range(), parameters_.averaging),
      readings_(parameters_.quiet ? std::numeric_limits<double>::infinity() : ForceLiveness::kReadings),
      measured_(cycle_.output<geometry_msgs::WrenchStamped>("force_sensor/measured_cf")),
      raw_(cycle_.output<geometry_msgs::WrenchStamped>("force_sensor/raw_cf")) {
  if (!parameters_.file.empty() && source_->size() == 2) {
    if (std::filesystem::exists(parameters_.file)) readout_.restore(readSensorCalibration(parameters_.file));
    file_.emplace(parameters_.file, writingOn(bus));
  }
  advertiseServices();
  watchController();
  cycle_.diagnostics().add(kStatus, [this](auto& status) { report(status); });
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

std::unique_ptr<ForceSource> ForceSensorNode::makeSource() {
  const Parameters& p = parameters_;
  if (p.source == "serial" && cycle_.bus().isVirtual()) {
    throw ConfigError("source = serial: the sensor on " + p.port.path +
                      " cannot run in virtual time, it measures on while time stands");
  }
  if (p.source == "topic") return std::make_unique<TopicForceSource>(cycle_, p.input_timeout, p.overload);
  tip_from_sensor_ = waitForFrame(cycle_.bus(), kTipFrame, p.frame, p.frame_timeout);
  if (p.source == "serial") {
    return std::make_unique<SerialForceSource>(p.port, p.voltages, p.overload, p.input_timeout, p.frame);
  }
  return std::make_unique<SimulatedForceSource>(cycle_, p.input_timeout, p.simulated, p.frame, tip_from_sensor_);
}

void ForceSensorNode::advertiseServices() {
  using cell_microinjection::CalibrateForce;
  using std_srvs::Trigger;
  Bus& bus = cycle_.bus();
  tare_ = bus.advertiseService<Trigger>("~tare", [this](Trigger::Request&, Trigger::Response& response) {
    const std::string reason = inUseReason().empty() ? notReadyReason() : inUseReason();
    const std::string refusal = reason.empty() ? readout_.beginTare() : reason;
    response.success = refusal.empty();
    response.message = refusal.empty() ? readout_.outcome() : refusal;
    return true;
  });
  reset_ = bus.advertiseService<Trigger>("~reset", [this](Trigger::Request&, Trigger::Response& response) {
    response.success = true;
    response.message = source_->overloaded()
                           ? "was overloaded, " + source_->overloadText() + ": check the sensor, then tare"
                           : "there was no fault";
    source_->reset();
    return true;
  });
  calibrate_ = bus.advertiseService<CalibrateForce>(
      "~calibrate", [this](CalibrateForce::Request& request, CalibrateForce::Response& response) {
        calibrate(request, response);
        return true;
      });
}

void ForceSensorNode::calibrate(const cell_microinjection::CalibrateForce::Request& request,
                                cell_microinjection::CalibrateForce::Response& response) {
  const std::string refusal = source_->size() == 2 ? act(request) : "a wrench is calibrated where it is measured";
  response.success = refusal.empty();
  response.message = refusal.empty() ? readout_.outcome() : refusal;
  const Eigen::MatrixXd by_columns = readout_.gain().transpose();
  response.gain.assign(by_columns.data(), by_columns.data() + by_columns.size());
  response.residual = readout_.residual();
  response.points = static_cast<std::uint32_t>(readout_.points());
}

std::string ForceSensorNode::act(const cell_microinjection::CalibrateForce::Request& request) {
  const bool changes_force = request.action != cell_microinjection::CalibrateForce::Request::ADD;
  if (changes_force && !inUseReason().empty()) return inUseReason();
  switch (request.action) {
    case cell_microinjection::CalibrateForce::Request::ADD: {
      if (!notReadyReason().empty()) return notReadyReason();
      const Eigen::Vector3d load = tip_from_sensor_.linear().transpose() * toVector(request.force);
      return readout_.beginPoint(Eigen::Vector2d(load.z(), load.x()));
    }
    case cell_microinjection::CalibrateForce::Request::SOLVE:
      return readout_.solve();
    case cell_microinjection::CalibrateForce::Request::CLEAR:
      return readout_.clear();
    case cell_microinjection::CalibrateForce::Request::UNDO:
      return readout_.undo();
    default:
      return "action must be ADD, SOLVE, CLEAR or UNDO";
  }
}

std::string ForceSensorNode::notReadyReason() const {
  if (source_->overloaded()) return "the sensor is overloaded: reset it first";
  return source_->saturated() ? "the sensor is saturated" : invalidReason();
}

std::string ForceSensorNode::invalidReason() const {
  if (!source_->invalidReason().empty() || !readings_.repeats()) return source_->invalidReason();
  return "repeats one reading, which its noise must change: it hangs, or it is quiet (sensor/quiet of the session)";
}

void ForceSensorNode::watchController() {
  using Operating = cell_microinjection::OperatingState;
  using Injection = cell_microinjection::InjectionStatus;
  controller_.push_back(subscribeGuarded<Operating>(
      cycle_.bus(), "controller/operating_state", 10,
      [this](const Operating& message, const std::string&) { controller_state_ = message.state; }));
  controller_.push_back(subscribeGuarded<Injection>(
      cycle_.bus(), "controller/injection_state", 1,
      [this](const Injection& message, const std::string&) { injection_state_ = message.state; }));
}

/// The force guard and the hand take what is published: a new tare in contact would move both by the whole force.
bool ForceSensorNode::inUse() const {
  const bool clear = injection_state_.empty() || injection_state_ == "idle" || injection_state_ == "approach";
  return controller_state_ == "ENABLED" && !clear;
}

std::string ForceSensorNode::inUseReason() const {
  return inUse() ? "the needle is led in contact: withdraw it or disable the controller" : "";
}

void ForceSensorNode::keepCalibration() {
  if (!file_ || kept_changes_ == readout_.changes()) return;
  kept_changes_ = readout_.changes();
  file_->write(toYaml(readout_.calibration()));
}

/// The operator waits for the end of an average: it must not wait for the next report of a second.
void ForceSensorNode::reportOutcome() {
  if (reported_outcome_ == readout_.outcome()) return;
  reported_outcome_ = readout_.outcome();
  cycle_.diagnostics().publish(kStatus);
}

void ForceSensorNode::step(const Cycle::Tick& tick) {
  keepCalibration();
  reportOutcome();
  const auto signal = source_->read(tick);
  // A saturated reading stays.
  if (signal) readings_.step(signal->values, source_->saturated() ? 0 : 1);
  if (!invalidReason().empty() || source_->overloaded()) return publishInvalid(tick);
  if (!signal) return;
  if (readout_.averaging() && source_->saturated()) readout_.interrupt("the sensor was saturated");
  if (readout_.averaging() && inUse()) readout_.interrupt("the needle is led in contact");
  raw_.publish(signal->raw);
  measured_.publish(atTip(readout_.read(signal->values, tick.now.toSec()), signal->stamp));
}

void ForceSensorNode::publishInvalid(const Cycle::Tick& tick) {
  readout_.interrupt("not every reading was valid");
  measured_.publishInvalid(toWrench(Eigen::Vector3d::Zero(), tick.now, kTipFrame));
  raw_.publishInvalid(toWrench(Eigen::Vector3d::Zero(), tick.now, parameters_.frame));
}

geometry_msgs::WrenchStamped ForceSensorNode::atTip(const Eigen::VectorXd& force, const ros::Time& stamp) const {
  // The force of a two-axis sensor acts at the tip, so there is no torque about it.
  if (force.size() == 2)
    return toWrench(tip_from_sensor_.linear() * Eigen::Vector3d(force[1], 0, force[0]), stamp, kTipFrame);
  geometry_msgs::WrenchStamped message = toWrench(force.head<3>(), stamp, kTipFrame);
  message.wrench.torque = toMessage<geometry_msgs::Vector3>(force.tail<3>());
  return message;
}

void ForceSensorNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string unwritten = file_ ? file_->error() : "";
  if (source_->overloaded()) {
    status.summary(DiagnosticStatus::ERROR, "overloaded: " + source_->overloadText() + "; call the service ~reset");
  } else if (!invalidReason().empty()) {
    status.summary(DiagnosticStatus::WARN, invalidReason());
  } else if (!unwritten.empty()) {
    status.summary(DiagnosticStatus::WARN, unwritten);
  } else {
    status.summary(source_->saturated() ? DiagnosticStatus::WARN : DiagnosticStatus::OK,
                   source_->saturated() ? "saturated" : "measures");
  }
  status.add("tare and calibration", readout_.outcome());
  status.add("calibration points", readout_.points());
  if (file_) status.add("calibration file", unwritten.empty() ? file_->path() : unwritten);
  source_->report(status);
}

}  // namespace microinjection
