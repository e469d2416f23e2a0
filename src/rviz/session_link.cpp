#include "rviz/session_link.h"

#include <algorithm>
#include <cmath>

#include "rviz/session_clock.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kFresh = 0.2;         // s, of a measured force in the plot
constexpr double kOld = 2;             // s, of what is shown of estimator, injector and hindrance
constexpr double kImplausible = 1e-2;  // N and m: what is beyond is no force or depth of a cell

constexpr char kController[] = "/injection_controller";

constexpr const char* kStoppedActions[] = {"calibration/calibrate", "focus/find", "touch/find",
                                           "visual_servo/go_to_pixel"};

std::optional<double> plausible(double value) {
  return std::abs(value) < kImplausible ? std::optional(value) : std::nullopt;
}

Eigen::Vector3d toVector(const geometry_msgs::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

}  // namespace

SessionLink::SessionLink(Bus& bus, std::function<std::optional<Pose>()> pipette)
    : bus_(bus),
      pipette_(std::move(pipette)),
      commands_(bus.advertise<cell_microinjection::StringStamped>("controller/state_command", 1)) {
  for (const std::string action : kStoppedActions)
    cancels_.push_back(bus.advertise<actionlib_msgs::GoalID>(action + "/cancel", 1));
  subscribe("controller/operating_state", &SessionLink::onOperating);
  subscribe("controller/injection_state", &SessionLink::onInjection);
  subscribe("controller/loop_state", &SessionLink::onLoop);
  subscribe("cell/state", &SessionLink::onCell);
  subscribe("cell/estimate", &SessionLink::onEstimate);
  subscribe("force_sensor/measured_cf", &SessionLink::onMeasured);
  subscribe("injector/state", &SessionLink::onInjector);
  subscribe("/session/readiness", &SessionLink::onReadiness);
  subscribe("/diagnostics", &SessionLink::onDiagnostics);
}

template <typename Message>
void SessionLink::subscribe(const std::string& topic, void (SessionLink::*receive)(const Message&)) {
  // Each node reports its diagnostics by itself, within the same millisecond as others.
  const std::uint32_t queue = topic == "/diagnostics" ? 50 : 1;
  subscriptions_.push_back(bus_.subscribe<Message>(
      topic, queue, [this, receive](const Delivery<Message>& delivery) { (this->*receive)(*delivery.message); }));
}

bool SessionLink::poll() {
  serveArrived(bus_);
  return std::exchange(grown_, false);
}

void SessionLink::send(const std::string& command) {
  cell_microinjection::StringStamped message;
  message.header.stamp = bus_.now();
  message.string = command;
  commands_.publish(message);
}

void SessionLink::stop(const std::string& command) {
  send(command);
  // An empty goal is every goal.
  for (const auto& cancel : cancels_) cancel.publish(actionlib_msgs::GoalID());
}

/// The parameters are set before the controller starts. To read them waits for the master, which is
/// why it is done only when a controller appears.
void SessionLink::readSettings() {
  ControllerSettings& settings = session_.settings;
  settings = {};
  SessionParameters parameters(bus_, kController);
  settings.mode = parameters.text("mode");
  settings.force_limit = parameters.number("force_limit");
  settings.depth_limit = parameters.number("depth_limit");
  if (const auto duration = parameters.number("goal/pulse/duration")) settings.has_pulse = *duration > 0;
  settings.has_holder = parameters.text("holder") == "true";
  if (const auto suction = parameters.number("goal/holding/suction")) settings.holds = *suction > 0;
  settings.has_suction = parameters.text("goal/break_by") != "force";
  settings.error = parameters.error();
}

SessionView SessionLink::session() const {
  SessionView view = session_;
  // What is sent before is lost.
  view.listens = commands_.isSubscribedBy(kController);
  if (sessionNow(bus_) - hindrance_.at < kOld) view.hindrance = hindrance_.value;
  if (heard_at_ && sessionNow(bus_) - *heard_at_ < kControllerSilence) return view;
  view.operating.reset();
  view.injection.reset();
  return view;
}

std::string SessionLink::servedCell() const {
  const bool changed = !changed_.empty() && changed_ != "as at the start" && changed_ != "are changing";
  return changed ? changed_ : served_;
}

Lamp SessionLink::lamp(Device device) const { return lamps_.lamp(device, sessionNow(bus_)); }

std::optional<CellEstimateView> SessionLink::estimate() const {
  return sessionNow(bus_) - estimate_.at < kOld ? estimate_.value : std::nullopt;
}

std::optional<InjectorView> SessionLink::injector() const {
  return sessionNow(bus_) - injector_.at < kOld ? injector_.value : std::nullopt;
}

/// What only informs is what the operator has ordered.
void SessionLink::onReadiness(const cell_microinjection::Readiness& message) {
  hindrance_ = {std::nullopt, sessionNow(bus_)};
  for (const auto& hindrance : message.hindrances) {
    if (hindrance.level == cell_microinjection::Hindrance::OK) continue;
    hindrance_.value = HindranceView{hindrance.node, hindrance.reason, hindrance.remedy,
                                     hindrance.level == cell_microinjection::Hindrance::ERROR};
    break;
  }
}

void SessionLink::onOperating(const cell_microinjection::OperatingState& message) {
  session_.operating = operatingStateOf(message.state);
  session_.homed = message.is_homed;
  session_.busy = message.is_busy;
}

void SessionLink::onInjection(const cell_microinjection::InjectionStatus& message) {
  if (!heard_at_ || sessionNow(bus_) - *heard_at_ > kControllerSilence) readSettings();
  heard_at_ = sessionNow(bus_);
  session_.injection = injectionStateOf(message.state);
  session_.waits = message.waits;
  session_.force = message.force;
  session_.guard_force = message.guard_force;
  session_.depth = message.depth;
  session_.volume = message.volume;
  session_.notice = message.notice;
  punctures_ = static_cast<int>(message.punctures);
}

void SessionLink::onLoop(const cell_microinjection::LoopState& message) { session_.hold_reason = message.hold_reason; }

void SessionLink::onCell(const cell_microinjection::CellState& message) {
  ForceHistory::Sample sample;
  sample.time = sessionNow(bus_);
  const auto pipette = pipette_();
  if (pipette && message.converged) sample.predicted = plausible(toVector(message.force).dot(pipette->axis));
  if (measured_.value && sample.time - measured_.at < kFresh) sample.measured = measured_.value->axial;
  if (message.in_contact || message.inside) {
    sample.depth = plausible(message.inside ? message.insertion_depth : message.indentation);
  }
  history_.add(sample);
  grown_ = true;
  if (row_handler_) row_handler_(rowOf(message, pipette));
}

SessionTable::Row SessionLink::rowOf(const cell_microinjection::CellState& message,
                                     const std::optional<Pose>& pipette) const {
  SessionTable::Row row;
  row.time = sessionNow(bus_);
  row.needle = pipette;
  if (pipette && message.converged) row.predicted = toVector(message.force);
  if (row.time - measured_.at < kFresh) row.measured = measured_.value;
  row.in_contact = message.in_contact;
  if (message.in_contact || message.inside) row.depth = message.inside ? message.insertion_depth : message.indentation;
  row.cell = {std::nullopt, message.punctured != 0, message.layers_punctured, message.holes.size()};
  row.injection = session_.injection ? toText(*session_.injection) : "";
  row.punctures = punctures_;
  if (const auto last = injector()) row.volume = last->volume;
  return row;
}

void SessionLink::onMeasured(const geometry_msgs::WrenchStamped& message) {
  measured_ = {std::nullopt, sessionNow(bus_)};
  if (message.header.stamp.isZero()) return;
  const Eigen::Vector3d force = toVector(message.wrench.force);
  std::optional<double> axial;
  if (message.header.frame_id == "needle_tip") {
    axial = plausible(force.z());
  } else if (const auto pipette = pipette_(); pipette && message.header.frame_id == "world") {
    axial = plausible(force.dot(pipette->axis));
  }
  if (!axial) return;
  const double lateral = message.header.frame_id == "needle_tip" ? force.x() : 0;
  measured_.value = SessionTable::Measured{*axial, lateral};
}

void SessionLink::onEstimate(const cell_microinjection::CellEstimate& message) {
  CellEstimateView view;
  view.verdict = message.verdict;
  view.reason = message.reason;
  view.modulus = message.modulus;
  view.low = message.modulus_low;
  view.high = message.modulus_high;
  view.served_modulus = message.served_modulus;
  const auto& puncture = message.puncture;
  const bool ordered = puncture.depth_low <= puncture.depth && puncture.depth <= puncture.depth_high;
  if (ordered && plausible(puncture.depth_high) && plausible(puncture.force)) {
    view.puncture_depth = puncture.depth;
    view.puncture_low = puncture.depth_low;
    view.puncture_high = puncture.depth_high;
    view.puncture_force = puncture.force;
  }
  estimate_ = {view, sessionNow(bus_)};
}

void SessionLink::onInjector(const cell_microinjection::InjectorState& message) {
  InjectorView view;
  view.pressure = message.pressure;
  view.volume = message.volume;
  view.busy = message.busy;
  view.pulses = message.pulses;
  view.fault = message.fault;
  view.refusal = message.refusal;
  injector_ = {view, sessionNow(bus_)};
}

void SessionLink::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    lamps_.receive({status.name, status.level, status.message}, sessionNow(bus_));
    if (status.name == "cell_simulator: cell parameters") changed_ = status.message;
    if (status.name != "cell_simulator: solver") continue;
    const auto served = std::find_if(status.values.begin(), status.values.end(),
                                     [](const auto& value) { return value.key == "served cell"; });
    if (served != status.values.end()) served_ = served->value;
  }
}

}  // namespace microinjection
