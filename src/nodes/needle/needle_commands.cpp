#include "nodes/needle/needle_commands.h"

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/latency_meter.h"

namespace microinjection {
namespace {

constexpr char kNeedleCommandTopic[] = "needle/state_command";

/// Commands that stop something are executed with any stamp and in any state.
bool stopsNeedle(const std::string& command) {
  return command == "stop" || command == "disable" || command == "pause" || command == "unhome";
}

}  // namespace

NeedleCommands::NeedleCommands(Cycle& cycle, const MicromanipulatorConfig& config, ManipulatorSetup& rig,
                               Micromanipulator& model, const Options& options)
    : cycle_(cycle),
      config_(config),
      rig_(rig),
      model_(model),
      servo_(cycle.input<geometry_msgs::PoseStamped>("needle/servo_cp", InputPhase::kDrives, config.command_timeout)),
      trace_(cycle.output<sensor_msgs::TimeReference>("needle/setpoint_trace")),
      repeated_(cycle.bus(), kNeedleCommandTopic),
      authority_(options.moved),
      log_(cycle.bus()) {
  if (!options.auto_enable) state_.command(StateCommand::kDisable);
  if (!rig.inject && !options.allow_network) network_ = std::make_unique<NetworkMonitor>();
  subscribe(options);
}

void NeedleCommands::subscribe(const Options& options) {
  servo_.stamp_rule = StampRule::kCommand;
  servo_.optional = !options.streamed;
  servo_.one_sender = false;  // authorize() names a second one
  // Checks each message between two steps, also those that a newer one replaces.
  servo_.onMessage([this](const geometry_msgs::PoseStamped& message, const ros::Time& now) {
    if (secondsBetween(message.header.stamp, now) <= config_.command_timeout) authorize(servo_.sender);
  });
  using geometry_msgs::PoseStamped;
  using geometry_msgs::TwistStamped;
  Bus& bus = cycle_.bus();
  subscriptions_ = {
      subscribeCommand<TwistStamped>(bus, "needle/servo_cv",
                                     [this](const auto& message, const auto& source) { onVelocity(message, source); }),
      subscribeCommand<PoseStamped>(bus, "needle/move_cp",
                                    [this](const auto& message, const auto& source) { onMove(message, source); }),
      subscribeCommand<cell_microinjection::StringStamped>(
          bus, kNeedleCommandTopic, [this](const auto& message, const auto& source) { onState(message, source); },
          StampRule::kAny)};
  if (rig_.inject) subscribeFaults();
}

void NeedleCommands::subscribeFaults() {
  using cell_microinjection::StringStamped;
  subscriptions_.push_back(subscribeGuarded<StringStamped>(
      cycle_.bus(), "needle/emulated_fault", 10,
      [this](const StringStamped& message, const std::string&) { onFault(message.string); }));
}

void NeedleCommands::onFault(const std::string& fault) {
  state_command_received_ = true;
  try {
    rig_.inject(fault, time());
  } catch (const ConfigError& error) {
    log_.addResult("emulated_fault", error.what());
  }
}

/// Age (s) of a command now, not at the last step: this node may have been frozen. Without a stamp
/// it is the largest possible age.
double NeedleCommands::age(const ros::Time& stamp) const {
  const ros::Time since = stamp.isZero() ? cycle_.earliestArrival() : stamp;
  return since.isZero() ? 0 : secondsBetween(since, std::max(now_, cycle_.bus().now()));
}

/// Executes a valid motion command if motion is allowed, and logs the result.
template <typename Execute>
void NeedleCommands::command(const std::string& name, const std::string& sender, const Execute& execute) {
  std::string refusal = unavailableReason();
  const bool moved = model_.busy();
  if (refusal.empty()) refusal = execute();
  log_.addResult(name, refusal);
  if (refusal.empty() && moved) log_.addOverride("move_cp of " + mover_, "by " + name + " of " + sender);
}

void NeedleCommands::onVelocity(const geometry_msgs::TwistStamped& message, const CommandSource& source) {
  if (source.unstamped && source.latched) return log_.addResult("servo_cv", kUnstampedLatched);
  geometry_msgs::TwistStamped stamped = message;
  if (source.unstamped) stamped.header.stamp = cycle_.bus().now();
  const auto velocity = validVelocity(&stamped);
  if (!velocity) return log_.addResult("servo_cv", "not a valid velocity in world");
  const double old = std::max(0.0, age(message.header.stamp));
  if (old > config_.velocity_command_timeout) return log_.addResult("servo_cv", "it is stale");
  authorize(source.sender);
  command("servo_cv", source.sender, [&] { return model_.servoVelocity(*velocity, time() - old); });
}

void NeedleCommands::onMove(const geometry_msgs::PoseStamped& message, const CommandSource& source) {
  if (source.unstamped && source.latched) return log_.addResult("move_cp", kUnstampedLatched);
  geometry_msgs::PoseStamped stamped = message;
  if (source.unstamped) stamped.header.stamp = cycle_.bus().now();
  const auto pose = validPose(&stamped);
  if (!pose) return log_.addResult("move_cp", "not a valid pose in world");
  if (age(message.header.stamp) > kOldestCommand) return log_.addResult("move_cp", "it is stale");
  authorize(source.sender);
  command("move_cp", source.sender, [&] {
    std::string refusal = model_.movePosition(*pose);
    if (refusal.empty()) busy_.accept(static_cast<std::int64_t>(cycle_.bus().now().toNSec()));
    return refusal;
  });
  if (log_.refusal().empty()) mover_ = source.sender;
}

void NeedleCommands::executeServo(const Cycle::Tick& tick) {
  const auto message = servo_.takeUpdates();
  if (!message) return;
  if (!servo_.fresh(tick.now)) return log_.addResult("servo_cp", master_lost_ ? unavailableReason() : "it is stale");
  const auto pose = validPose(message.get());
  if (!pose) return log_.addResult("servo_cp", "not a valid pose in world");
  command("servo_cp", servo_.sender, [&] { return model_.servoPosition(*pose); });
  if (isTraced(tick.now)) trace_.publish(toTrace(tick.now, message->header.stamp, "hand"));
}

void NeedleCommands::onState(const cell_microinjection::StringStamped& message, const CommandSource& source) {
  state_command_received_ = true;
  const bool moved = model_.busy();
  const std::string refusal = executeState(message, source);
  log_.addResult("state_command " + message.string, refusal);
  if (moved && stopsNeedle(message.string))
    log_.addOverride("move_cp of " + mover_, "by " + message.string + " of " + source.sender);
}

std::string NeedleCommands::executeState(const cell_microinjection::StringStamped& message,
                                         const CommandSource& source) {
  const bool old = repeated_.mayBe(source);
  const std::string& name = message.string;
  if (stopsNeedle(name)) model_.stop();
  if (name == "stop") return "";
  const auto command = stateCommandOf(name);
  if (!command) {
    return "\"" + name + "\" is no command here; allowed: enable, disable, pause, resume, home, unhome, stop";
  }
  if (!stopsNeedle(name)) {
    if (!isTimely(cycle_.bus().refusals(), kNeedleCommandTopic, message, now_)) return "its stamp is ahead";
    if (!source.unstamped && age(message.header.stamp) > kOldestCommand) return "it is stale";
    if (old) return std::string(kUnstampedLatched) + "; send it again";
  }
  state_.setConditions(conditions());
  const bool fault = state_.state() == OperatingState::kFault;
  std::string refusal = state_.command(*command);
  if (refusal.empty()) change(*command, fault);
  return refusal;
}

/// Effects of a command other than the state. `fault`: the state before was FAULT.
void NeedleCommands::change(StateCommand command, bool fault) {
  switch (command) {
    case StateCommand::kDisable:
      if (!fault) break;
      [[fallthrough]];
    case StateCommand::kEnable:
      authority_.clear();
      model_.clearFault();
      break;
    case StateCommand::kResume:
      model_.allowStreams();
      break;
    case StateCommand::kHome:  // the axes are referenced, so there is no search
      busy_.accept(static_cast<std::int64_t>(cycle_.bus().now().toNSec()));
      model_.allowStreams();
      break;
    case StateCommand::kPause:
    case StateCommand::kUnhome:
      break;
  }
  state_.setConditions(conditions());
}

void NeedleCommands::authorize(const std::string& sender) {
  if (!unavailableReason().empty()) return;
  if (authority_.authorize(sender, time())) return;
  model_.stop();
  state_.setConditions(conditions());
  ROS_ERROR_STREAM(authority_.fault());
}

/// A disconnected device does not count as moving.
bool NeedleCommands::moves() const {
  const bool there = model_.state() != ManipulatorDevice::State::kDisconnected;
  return there && (model_.moving() || rig_.device->moving());
}

/// Decides whether the rig may be enabled. A needle in a cell may still be withdrawn when an
/// interface comes up.
void NeedleCommands::checkNetwork() {
  if (!network_) return;
  const bool reachable = network_->reachable();
  if (state_.disabledByCommand()) admitted_ = false;
  admitted_ = admitted_ || (!reachable && !state_.disabledByCommand());
  exposed_ = reachable && !admitted_;
}

NeedleState::Conditions NeedleCommands::conditions() const {
  NeedleState::Conditions conditions{model_.state(), model_.joints().has_value(), authority_.fault(), ""};
  if (!exposed_) return conditions;
  conditions.barrier = "others can reach this machine's nodes through " + network_->interfaces() +
                       "; allowed without these interfaces (./dev shell --isolated), or with allow_network = true";
  return conditions;
}

std::string NeedleCommands::unavailableReason() const {
  return master_lost_ ? "the ROS master is lost" : state_.unavailableReason();
}

std::string NeedleCommands::streamHold() const {
  std::string reason = unavailableReason();
  return reason.empty() ? model_.streamHold() : reason;
}

void NeedleCommands::step(const Cycle::Tick& tick) {
  if (tick.now < now_) set_back_ += secondsBetween(tick.now, now_);
  now_ = tick.now;
  // Stops motions under way, too: no new node could stop them.
  if (cycle_.masterLost() && !master_lost_) model_.stop();
  master_lost_ = cycle_.masterLost();
  checkNetwork();
  state_.setConditions(conditions());
  executeServo(tick);
}

void NeedleCommands::endStep() { authority_.step(time(), moves()); }

bool NeedleCommands::isBusy(const Cycle::Tick& tick) {
  state_.setConditions(conditions());
  if (model_.abortReason() != abort_reason_ && !model_.abortReason().empty())
    ROS_WARN_STREAM("the motion ended: " << model_.abortReason());
  abort_reason_ = model_.abortReason();
  return busy_.step(model_.busy(), static_cast<std::int64_t>(tick.now.toNSec()));
}

bool NeedleCommands::takeStateCommandReceived() { return std::exchange(state_command_received_, false); }

void NeedleCommands::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  std::string problem = log_.takeUpdates();
  if (problem.empty()) problem = model_.abortReason();
  const bool held = exposed_ || !authority_.fault().empty();
  const std::string reason = model_.reason().empty() && held ? unavailableReason() : model_.reason();
  if (!reason.empty() && problem != reason) problem = reason + (problem.empty() ? "" : "; ") + problem;
  const auto level = !reason.empty()   ? DiagnosticStatus::ERROR
                     : problem.empty() ? DiagnosticStatus::OK
                                       : DiagnosticStatus::WARN;
  status.summary(level, !problem.empty() ? problem : model_.moving() ? "moves" : "holds");
  status.add("device", rig_.device->abilities().device);
  status.add("device's note", rig_.device->note());
  status.add("operating state", toText(state_.state()));
  if (network_ && network_->reachable() && admitted_) {
    status.mergeSummary(DiagnosticStatus::ERROR, "others can reach this machine now through " + network_->interfaces() +
                                                     ": after disable it is not enabled again");
  }
  log_.addCounts(status);
}

}  // namespace microinjection
