#include "nodes/injection_controller_node.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "nodes/runtime/conversions.h"
#include "nodes/runtime/force_topic.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr char kControllerCommandTopic[] = "controller/state_command";
constexpr double kInterfaceTimeout = 0.1;  ///< s, of images at 20 Hz and more; less than a tongue takes to spring back
constexpr double kNeedleRests = 0.5e-6;    ///< m beyond the rig's resolution, within which a set-point is no motion
constexpr double kNeedleStands = 0.2;      ///< s beyond the rig's times, for which its pose may stay in a motion

/// Commands that stop or withdraw the needle are executed with any stamp.
bool stopsOrWithdraws(const std::string& command) {
  return command == "disable" || command == "pause" || command == "home" || command == "unhome" ||
         command == "withdraw";
}

/// Commands that start a motion of the controller.
bool moves(const std::string& command) {
  return command == "home" || command == "withdraw" || command == "approach" || command == "hold";
}

}  // namespace

const char* const InjectionControllerNode::kHelp =
    "injection_controller: controls the needle and holds it when an input is invalid.\n"
    "In: /teleop/servo_cp /needle/measured_cp /needle/setpoint_cp, /cell/predicted_cf or /force_sensor/measured_cf, "
    "/injector/state,\n"
    "/needle/interface, /needle/abilities, /needle/operating_state, /needle/loop_state, /cell/estimate, "
    "/controller/state_command "
    "(enable, disable, pause, resume, home, unhome, "
    "hold, approach,\n"
    "indent, aspirate, inject, withdraw, release), with a holder /holder/state /cell/hold /vision/state. Action: "
    "/controller/inject.\n"
    "Out: /needle/servo_cp /controller/operating_state /controller/injection_state /injector/pulse /injector/stop, "
    "with "
    "a holder\n"
    "/holder/set_pressure.\n";

InjectionControllerNode::Parameters InjectionControllerNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("rate", parameters.rate, Range::closed(50, 5000));
  reader.number("input_timeout", parameters.input_timeout, Range::positive());
  reader.choice("force_source", parameters.force_source, {"predicted", "measured"});
  reader.boolean("quiet_sensor", parameters.quiet_sensor);
  reader.boolean("auto_enable", parameters.auto_enable);
  reader.boolean("injector", parameters.injector);
  parameters.model = InjectionControllerConfig::read(reader);
  parameters.model.witness.measured = parameters.force_source == "predicted";
  reader.finish();
  return parameters;
}

InjectionControllerNode::InjectionControllerNode(Bus& bus)
    : parameters_(Parameters::read(bus)),
      model_(parameters_.model),
      cycle_(bus, parameters_.rate),
      needle_(cycle_.input<geometry_msgs::PoseStamped>("needle/measured_cp", InputPhase::kSampled,
                                                       parameters_.input_timeout)),
      force_(cycle_.input<geometry_msgs::WrenchStamped>(forceTopic(parameters_.force_source), InputPhase::kSampled,
                                                        parameters_.input_timeout)),
      interface_(cycle_.input<cell_microinjection::InterfacePosition>("needle/interface", InputPhase::kSampled,
                                                                      kInterfaceTimeout)),
      setpoint_(cycle_.output<geometry_msgs::PoseStamped>("needle/servo_cp")),
      injection_(cycle_.output<cell_microinjection::InjectionStatus>("controller/injection_state", true)),
      force_lives_(cycle_, force_,
                   parameters_.force_source == "predicted" ? ForceLiveness::Source::kModel
                                                           : sensorThatIs(parameters_.quiet_sensor)),
      needle_poses_(1),
      rig_(bus),
      witnesses_(cycle_, parameters_.force_source, parameters_.input_timeout, parameters_.quiet_sensor),
      loop_state_(bus, "controller/loop_state"),
      action_(bus, model_, parameters_.model.goal),
      repeated_(bus, kControllerCommandTopic),
      log_(bus) {
  interface_.optional = true;
  needle_.onMessage(
      [this](const geometry_msgs::PoseStamped& needle, const ros::Time& now) { watchNeedle(needle, now); });
  if (parameters_.model.mode == "manual") {
    target_ =
        &cycle_.input<geometry_msgs::PoseStamped>("teleop/servo_cp", InputPhase::kDrives, parameters_.input_timeout);
  }
  if (parameters_.model.holder) holder_ = std::make_unique<HolderLink>(cycle_, parameters_.input_timeout);
  if (parameters_.injector) injector_ = std::make_unique<InjectorLink>(cycle_, parameters_.input_timeout);
  state_ = bus.advertise<cell_microinjection::OperatingState>("controller/operating_state", 10, true);
  subscribeCommands();
  using cell_microinjection::ManipulatorAbilities;
  abilities_ = subscribeGuarded<ManipulatorAbilities>(
      bus, "needle/abilities", 1,
      [this](const ManipulatorAbilities& message, const std::string&) { adaptTo(message); });
  using cell_microinjection::CellEstimate;
  estimates_ = subscribeGuarded<CellEstimate>(
      bus, "cell/estimate", 1, [this](const CellEstimate& message, const std::string&) { receiveEstimate(message); });
  rig_setpoints_ = subscribeMeasured<geometry_msgs::PoseStamped>(
      bus, "needle/setpoint_cp", 1, [this, &bus](const geometry_msgs::PoseStamped& message, const std::string&) {
        rig_setpoint_ = validPosition(&message, kWorldFrame);
        rig_setpoint_heard_ = bus.now();
      });
  cycle_.diagnostics().add("control", [this](auto& status) { report(status); });
  if (parameters_.auto_enable) execute("enable");
  cycle_.onStep([this](const Cycle::Tick& tick) { step(tick); });
}

void InjectionControllerNode::subscribeCommands() {
  using cell_microinjection::StringStamped;
  commands_ = subscribeCommand<StringStamped>(
      cycle_.bus(), kControllerCommandTopic,
      [this](const StringStamped& message, const CommandSource& source) {
        receiveCommand(message, source.latched, repeated_.mayBe(source));
      },
      StampRule::kAny);
}

/// Commands that stop are always executed. A command that starts a motion must not be an old one
/// that a latching publisher repeats. This includes home and withdraw, whose stamps are not checked
/// otherwise.
void InjectionControllerNode::receiveCommand(const cell_microinjection::StringStamped& message, bool latched,
                                             bool repeated) {
  const std::string& command = message.string;
  state_command_received_ = true;
  const ros::Time &stamp = message.header.stamp, now = cycle_.bus().now();
  if (!stopsOrWithdraws(command) && !isTimely(cycle_.bus().refusals(), kControllerCommandTopic, message, now)) return;
  const bool stale = !stamp.isZero() && secondsBetween(stamp, now) > kOldestCommand;
  const bool begins = !stopsOrWithdraws(command) || (moves(command) && latched);
  if (begins && stale) return log_.addResult("state command " + command, "it is stale");
  if (begins && repeated) {
    return log_.addResult("state command " + command, std::string(kUnstampedLatched) + "; send it again");
  }
  execute(command);
}

void InjectionControllerNode::execute(const std::string& command) {
  const bool ran = model_.running();
  const std::string refusal = model_.command(command);
  logged_notice_ = model_.notice();
  log_.addResult("state command " + command, refusal);
  if (!refusal.empty()) return;
  needle_poses_.reset();  // the set-point may start anew at the needle
  needle_.repeats.clear();
  ROS_INFO_STREAM("state command " << command << ": " << toText(model_.state()));
  if (ran && !model_.running()) log_.addOverride("the injection", "by " + command);
  if (moves(command) && (command != "hold" || model_.running()))
    busy_.accept(static_cast<std::int64_t>(cycle_.bus().now().toNSec()));
}

void InjectionControllerNode::adaptTo(const cell_microinjection::ManipulatorAbilities& rig) {
  std::ostringstream negative;
  if (!(rig.latency >= 0 && rig.command_interval >= 0))
    negative << "latency = " << rig.latency << " s, command_interval = " << rig.command_interval
             << " s, allowed [0, inf)";
  needle_patience_ = kNeedleStands + rig.latency + rig.command_interval + rig.reading_interval;
  needle_step_ = rig.resolution;
  const double before = model_.speedLimit();
  const std::string refusal =
      negative.str().empty() ? model_.adaptTo(rig.speed, rig.latency + rig.command_interval) : negative.str();
  if (!refusal.empty()) {
    ROS_ERROR_STREAM("rig: the abilities of " << rig.device << " are ignored: " << refusal);
    return;
  }
  if (model_.speedLimit() == before && adapted_) return;  // the abilities are published repeatedly
  adapted_ = true;
  ROS_INFO_STREAM("rig: " << rig.device << ", driven at " << model_.speedLimit() << " m/s at the most");
}

/// An estimator that is contradicted by the force expects nothing.
void InjectionControllerNode::receiveEstimate(const cell_microinjection::CellEstimate& message) {
  const auto& puncture = message.puncture;
  estimated_ = message.header.stamp;
  expected_ = ExpectedPuncture{puncture.force_low, puncture.force_high, puncture.depth_low, puncture.depth_high};
  if (message.verdict == "inconsistent") expected_.reset();
}

/// While the estimator is alive.
std::optional<ExpectedPuncture> InjectionControllerNode::expectedPuncture(const ros::Time& now) const {
  if (!expected_) return std::nullopt;
  const double age = secondsBetween(estimated_, now);
  return std::abs(age) <= parameters_.model.expectation.timeout ? expected_ : std::nullopt;
}

/// A rig that was commanded to move, and has not for this long, does not read its position; or it is stuck. A set-point
/// that the rig refuses, as one beyond the end of its travel, is no motion: its own set-point counts where it tells
/// one.
void InjectionControllerNode::watchNeedle(const geometry_msgs::PoseStamped& needle, const ros::Time& now) {
  const double dt = watched_.isZero() ? 0 : std::max(0.0, secondsBetween(watched_, now));
  watched_ = now;
  if (needle.header.stamp.isZero()) needle_poses_.reset();
  const bool rig_tells = rig_setpoint_ && !isDue(rig_setpoint_heard_, now, parameters_.input_timeout);
  const auto sent = commanded_ && rig_tells ? rig_setpoint_ : commanded_;
  // The set-point that belongs to a pose comes behind it.
  if (needle_poses_.changes(toVector(needle.pose.position)) || !sent) {
    setpoint_then_.reset();
  } else if (!setpoint_then_) {
    setpoint_then_ = sent;
  }
  const bool is_sent = sent && setpoint_then_ && (*sent - *setpoint_then_).norm() > kNeedleRests + needle_step_;
  if (is_sent) needle_poses_.expose(dt / needle_patience_);
  needle_.repeats = needle_poses_.repeats() ? "one pose, although it was sent elsewhere" : "";
}

/// By the force that it acts on, a cell none of whose membranes has failed.
bool InjectionControllerNode::feelsContact() const {
  const InjectionState state = model_.injection();
  const bool in_contact =
      state == InjectionState::kContact || state == InjectionState::kIndent || state == InjectionState::kAspirate;
  return in_contact && model_.punctures() == 0 && model_.monitor().touched();
}

void InjectionControllerNode::step(const Cycle::Tick& tick) {
  const auto* target = target_ ? target_->get(tick.now) : nullptr;
  const auto needle = validPose(needle_.get(tick.now));
  InjectionController::Input input;
  input.target = validPosition(target, kWorldFrame);
  if (injector_) input.injector = injector_->report(tick.now);
  if (holder_) {
    input.holder = holder_->report(tick.now);
    input.cell_hold = holder_->cell(tick.now);
  }
  const bool interface_is_new = interface_.takeUpdates() != nullptr;
  const auto* seen = interface_.get(tick.now);
  if (seen && std::isfinite(seen->position)) input.interface = InterfaceReading{seen->position, interface_is_new};
  input.rig_hold = rig_.takeHold();
  input.expected = expectedPuncture(tick.now);
  const bool acts_on_sensor = parameters_.force_source == "measured";
  force_lives_.step(needle ? std::optional<Eigen::Vector3d>(needle->translation()) : std::nullopt,
                    acts_on_sensor && feelsContact());
  input.force_is_new = force_.takeUpdates() != nullptr;
  if (needle) {
    input.needle = needle->translation();
    input.axis = needle->linear().col(2);
    input.force = validForce(force_.get(tick.now), needle->linear());
    witnesses_.fill(*needle, tick.now, input);
  }
  const bool rig_follows = input.rig_hold.empty();
  const auto setpoint = model_.step(std::move(input), tick.dt);
  if (setpoint) {
    Eigen::Isometry3d pose = needle ? *needle : Eigen::Isometry3d::Identity();
    pose.translation() = *setpoint;
    setpoint_.publish(toPose(pose, target && model_.followsTarget() ? target->header.stamp : tick.now, kWorldFrame));
  }
  const bool is_commanded = model_.state() == OperatingState::kEnabled && rig_follows;
  commanded_ = is_commanded ? setpoint : std::nullopt;
  if (injector_) injector_->setPulse(model_.pulse(), tick.now);
  if (holder_) holder_->command(model_.holderCommand(), tick.now);
  action_.step(tick.now);
  logNotice();
  publishState(tick.now);
  loop_state_.step(model_.holdReason(), tick.now);
  publishInjection(tick.now);
}

void InjectionControllerNode::logNotice() {
  if (model_.notice() == logged_notice_) return;
  logged_notice_ = model_.notice();
  if (!logged_notice_.empty()) ROS_WARN_STREAM(logged_notice_);
}

void InjectionControllerNode::publishState(const ros::Time& now) {
  cell_microinjection::OperatingState state;
  state.state = toText(model_.state());
  state.is_homed = model_.homed();
  state.is_busy = busy_.step(model_.busy(), static_cast<std::int64_t>(now.toNSec()));
  if (busy_.pending() && state.is_busy == last_published_state_.is_busy) return;
  const bool same = state.state == last_published_state_.state && state.is_homed == last_published_state_.is_homed &&
                    state.is_busy == last_published_state_.is_busy;
  if (same && !std::exchange(state_command_received_, false)) return;
  state_command_received_ = false;
  state.header.stamp = now;
  state_.publish(state);
  last_published_state_ = state;
}

void InjectionControllerNode::publishInjection(const ros::Time& now) {
  constexpr double kPeriod = 0.1;  // s, without a change
  const InjectionFeedback& feedback = model_.feedback();
  cell_microinjection::InjectionStatus status;
  status.header.stamp = now;
  status.state = toText(feedback.state);
  status.waits = model_.awaitsCommand();
  status.punctures = static_cast<std::uint32_t>(model_.punctures());
  status.force = feedback.force;
  status.guard_force = model_.guardForce();
  status.depth = feedback.depth;
  status.volume = model_.injectedVolume();
  status.outcome = toText(model_.result().outcome);
  status.reason = model_.result().reason;
  status.notice = model_.notice();
  const auto& last = last_published_injection_;
  const bool same = status.state == last.state && status.waits == last.waits && status.punctures == last.punctures &&
                    status.outcome == last.outcome && status.notice == last.notice;
  if (same && !isDue(last.header.stamp, now, kPeriod)) return;
  injection_.publish(status);
  last_published_injection_ = status;
}

void InjectionControllerNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const bool fault = model_.state() == OperatingState::kFault;
  const bool good = model_.holdReason().empty();
  const std::string updates = log_.takeUpdates();
  const std::string text = good ? "the needle follows" : "needle held: " + model_.holdReason();
  status.summary(fault                     ? diagnostic_msgs::DiagnosticStatus::ERROR
                 : good && updates.empty() ? diagnostic_msgs::DiagnosticStatus::OK
                                           : diagnostic_msgs::DiagnosticStatus::WARN,
                 text + (updates.empty() ? "" : "; ") + updates);
  log_.addCounts(status);
  if (const std::string word = model_.disagreement(); !word.empty())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, word);
  status.add("state", toText(model_.state()));
  status.add("speed limit (m/s)", model_.speedLimit());
}

}  // namespace microinjection
