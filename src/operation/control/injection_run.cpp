#include "operation/control/injection_run.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kArrived = 0.3e-6;  ///< m of lag within which the needle counts as arrived
constexpr char kStillHeld[] = "the cell is still held";
constexpr double kSettling = 0.5;  ///< s, after which it counts as arrived anyway

/// Whether the goal was reached: only then a cell is let go.
bool isDone(InjectionOutcome outcome) {
  return outcome == InjectionOutcome::kInjected || outcome == InjectionOutcome::kPunctured ||
         outcome == InjectionOutcome::kIndented;
}

/// What would be begun, and is not when it must stop; other events have happened.
bool begins(InjectionEvent event) {
  return event == InjectionEvent::kIndent || event == InjectionEvent::kAspirate || event == InjectionEvent::kInject;
}

/// Whether the needle does what it must not do to a cell that gives way.
bool needsHold(InjectionState state) {
  return state == InjectionState::kApproach || state == InjectionState::kContact || state == InjectionState::kIndent ||
         state == InjectionState::kAspirate || state == InjectionState::kPunctured || state == InjectionState::kInject;
}

}  // namespace

InjectionMotionConfig InjectionMotionConfig::read(ConfigReader& reader) {
  InjectionMotionConfig config;
  reader.number("approach_speed", config.approach_speed, Range::positive());
  reader.number("travel_limit", config.travel_limit, Range::positive());
  reader.number("indent_speed", config.indent_speed, Range::positive());
  reader.number("stab_speed", config.stab_speed, Range::positive());
  reader.number("stab_acceleration", config.stab_acceleration, Range::positive());
  reader.number("overshoot", config.overshoot, Range::positive());
  reader.number("stop_time", config.stop_time, Range::nonNegative());
  reader.number("retract_speed", config.retract_speed, Range::positive());
  reader.number("injector_timeout", config.injector_timeout, Range::positive());
  if (config.stab_speed < config.indent_speed) reader.error("stab_speed", "must not be below indent_speed");
  return config;
}

InjectionRun::InjectionRun(const InjectionMotionConfig& config, const GuardConfig& guards,
                           const ExpectationConfig& expectation, const BreakDetectionConfig& breaks, bool automatic)
    : config_(config), guards_(guards), expectation_(expectation), breaks_(breaks), automatic_(automatic) {}

void InjectionRun::start(const InjectionGoal& goal, const Eigen::Vector3d& tip) {
  const double speed_limit = speed_limit_;
  *this = InjectionRun(config_, guards_, expectation_, breaks_, automatic_);
  speed_limit_ = speed_limit;
  goal_ = goal;
  start_ = tip;
  active_ = true;
}

std::string InjectionRun::confirm(InjectionEvent event, InjectionState state) {
  if (automatic_) return "mode is automatic: the injection needs no command";
  if (!active_) return "no injection is under way";
  if (event == InjectionEvent::kAspirate && goal_.break_by == BreakBy::kForce) return "the goal has no suction";
  if (event == InjectionEvent::kInject && (injected_ || goal_.pulse.duration <= 0)) {
    return injected_ ? "it is injected already" : "the goal has no pulse";
  }
  const InjectionState from = event == InjectionEvent::kStart      ? InjectionState::kHold
                              : event == InjectionEvent::kIndent   ? InjectionState::kContact
                              : event == InjectionEvent::kAspirate ? InjectionState::kIndent
                              : event == InjectionEvent::kRelease  ? InjectionState::kRelease
                                                                   : InjectionState::kPunctured;
  const bool fits = state == state_ && state == from && (event != InjectionEvent::kAspirate || drawsNext());
  if (!awaits_command_ || !fits)
    return std::string("it is no step from ") + toText(state) + (awaits_command_ ? "" : " yet");
  confirmed_ = event;
  return "";
}

InjectionOutcome InjectionRun::done() const {
  if (injected_) return InjectionOutcome::kInjected;
  const bool through = result_.punctures >= goal_.layers;
  if (goal_.puncture && through && goal_.pulse.duration <= 0) return InjectionOutcome::kPunctured;
  if (!goal_.puncture && state_ == InjectionState::kIndent && awaits_command_) return InjectionOutcome::kIndented;
  return InjectionOutcome::kPreempted;
}

void InjectionRun::withdraw() {
  state_time_ = 0;                                           // also after a time guard during a withdrawal
  if (state_ == InjectionState::kRelease) released_ = true;  // no more than it is
  if (!active_ || outcome_ != InjectionOutcome::kNone) return;
  outcome_ = done();
}

void InjectionRun::end(InjectionOutcome outcome, const std::string& reason) {
  if (!active_) return;
  active_ = awaits_command_ = false;
  result_.outcome = outcome;
  result_.reason = reason;
}

void InjectionRun::beginWithdrawal(InjectionOutcome outcome, const std::string& reason, Step& step) {
  outcome_ = outcome;
  reason_ = reason;
  step.event = InjectionEvent::kWithdraw;
}

/// Whether the step that `event` begins may start now.
bool InjectionRun::mayProceed(InjectionEvent event) {
  awaits_command_ = !automatic_;
  if (automatic_) return true;
  if (confirmed_ != event) return false;
  confirmed_.reset();
  awaits_command_ = false;
  return true;
}

std::string InjectionRun::wait(InjectionState state, double dt) {
  if (needleWaits(state)) return "";  // Holding has its own limits
  state_time_ += dt;
  return timeGuard(guards_, toText(state), state_time_);
}

InjectionRun::Step InjectionRun::step(InjectionState state, const NeedleMonitor& monitor,
                                      const std::optional<InjectorReport>& injector, const Eigen::Vector3d& setpoint,
                                      const Eigen::Vector3d& axis, double dt) {
  if (state != state_) enter(state, monitor);
  state_time_ += awaits_command_ || needleWaits(state) ? 0 : dt;
  if (active_) {
    result_.duration += dt;
    result_.peak_force = std::max(result_.peak_force, monitor.peakForce());
    result_.max_depth = std::max(result_.max_depth, monitor.maxDepth());
  }
  // Starts from the set-point, which may have waited for the needle or been moved back to it.
  travel_ = std::min(travel_, (start_ - setpoint).dot(axis));
  Step step;
  awaits_command_ = false;
  if (state == InjectionState::kHold) holdCell(step);
  if (state == InjectionState::kApproach) approach(monitor, dt, step);
  if (state == InjectionState::kContact) contact(monitor, step);
  if (state == InjectionState::kIndent) indent(monitor, dt, step);
  if (state == InjectionState::kAspirate) aspirate(monitor, injector, dt, step);
  if (state == InjectionState::kPunctured) through(monitor, dt, step);
  if (state == InjectionState::kInject) inject(injector, dt, step);
  if (state == InjectionState::kWithdraw) retract(dt, step);
  if (state == InjectionState::kRelease) releaseCell(step);
  step.target = start_ - travel_ * axis;
  if (!step.stop && needsHold(state) && holding_ && step.event != InjectionEvent::kWithdraw)
    step.reason = holding_->loss();
  if (!step.stop && !step.event && step.reason.empty() && !needleWaits(state))
    step.reason = timeGuard(guards_, toText(state), state_time_);
  if (step.stop || step.reason.empty() || step.event == InjectionEvent::kOut) return step;
  step.stop = InjectionOutcome::kGuard;
  if (step.event && begins(*step.event)) step.event.reset();
  return step;
}

void InjectionRun::enter(InjectionState state, const NeedleMonitor& monitor) {
  state_ = state;
  state_time_ = rested_ = speed_ = 0;
  awaits_command_ = false;
  confirmed_.reset();
  suction_.reset();
  if (state == InjectionState::kContact) touch_travel_ = layer_travel_ = travel_;
  if (state == InjectionState::kIndent) {
    end_travel_ = touch_travel_ + std::min(goal_.depth, guards_.depth_limit);
    if (drawsFirst()) end_travel_ = std::max(travel_, std::min(end_travel_, layer_travel_ + goal_.suction.dent));
  }
  if (state == InjectionState::kPunctured && !injected_) {
    const double deep = std::min(monitor.depth() + goal_.margin, guards_.depth_limit);
    end_travel_ = std::max(travel_, touch_travel_ + deep);
  }
  if (state == InjectionState::kInject) wait_.start(goal_.pulse, config_.injector_timeout);
}

void InjectionRun::approach(const NeedleMonitor& monitor, double dt, Step& step) {
  if (!monitor.ready()) return;
  if (monitor.touched()) {
    step.event = InjectionEvent::kTouch;
    return;
  }
  travel_ = std::min(config_.travel_limit, travel_ + std::min(config_.approach_speed, speed_limit_) * dt);
  if (travel_ >= config_.travel_limit)
    beginWithdrawal(InjectionOutcome::kNoContact, "no cell within the travel limit", step);
}

void InjectionRun::contact(const NeedleMonitor& monitor, Step& step) {
  if (!monitor.confirmed()) return;
  if (!*monitor.confirmed()) {
    ++result_.false_touches;
    step.event = InjectionEvent::kLost;
    return;
  }
  if (mayProceed(InjectionEvent::kIndent)) step.event = InjectionEvent::kIndent;
}

std::optional<ExpectedPuncture> InjectionRun::expected() const {
  const bool known = goal_.puncture && result_.punctures == 0 && expected_ && expected_->plausible();
  return known ? expected_ : std::nullopt;
}

std::string InjectionRun::unexpected(const NeedleMonitor& monitor) const {
  const auto expected = this->expected();
  if (!expected) return "";
  const std::string reason = unreachable(*expected, guards_, goal_.depth);
  return reason.empty() ? exceeded(*expected, expectation_, monitor.promptForce()) : reason;
}

double InjectionRun::stabSpeed(const NeedleMonitor& monitor, double dt) const {
  // A further membrane must not fail in the same fall of the force: its puncture would not be
  // detected.
  const double overshoot = (result_.punctures + 1 < goal_.layers ? 0.5 : 1) * config_.overshoot;
  const auto expected = this->expected();
  const double failing = std::max(monitor.force(), expected ? expected->force_low : 0);
  const double fast = overshoot / (monitor.latencyAt(failing) * dt + config_.stop_time);
  const bool stabs = goal_.puncture && !drawsFirst();
  const double wanted = std::clamp(stabs ? fast : 0, config_.indent_speed, config_.stab_speed);
  const double faster = std::min(wanted, std::max(speed_, config_.indent_speed) + config_.stab_acceleration * dt);
  const double room = end_travel_ - travel_ - std::max(speed_, faster) * (config_.stop_time + dt);
  const double braking = std::sqrt(2 * config_.stab_acceleration * std::max(0.0, room));
  return std::max(config_.indent_speed, std::min(std::max(speed_, faster), braking));
}

void InjectionRun::indent(const NeedleMonitor& monitor, double dt, Step& step) {
  if (monitor.punctured()) {
    countPuncture(monitor, monitor.forceBefore(), step);
    return;
  }
  step.reason = unexpected(monitor);
  if (!step.reason.empty()) {
    step.stop = InjectionOutcome::kGuard;
    return;
  }
  speed_ = stabSpeed(monitor, dt);
  travel_ = std::min(end_travel_, travel_ + std::min(speed_, speed_limit_) * dt);
  if (travel_ < end_travel_) return;
  rested_ += dt;
  const bool there = monitor.depth() >= end_travel_ - touch_travel_ - kArrived || rested_ > kSettling;
  if (there && drawsNext()) {
    if (mayProceed(InjectionEvent::kAspirate)) step.event = InjectionEvent::kAspirate;
  } else if (goal_.puncture && there) {
    step.stop = InjectionOutcome::kNotPunctured;
    step.reason = "the membrane is not punctured at the goal's depth";
  }
  if (!goal_.puncture && rested_ >= goal_.hold_time) {
    awaits_command_ = !automatic_;
    if (automatic_) beginWithdrawal(InjectionOutcome::kIndented, "", step);
  }
}

/// Whether suction is to break the membrane before the needle, and has not failed to.
bool InjectionRun::drawsNext() const {
  return goal_.puncture && goal_.break_by != BreakBy::kForce && !drew_ && result_.punctures == goal_.layers - 1;
}

void InjectionRun::aspirate(const NeedleMonitor& monitor, const std::optional<InjectorReport>& injector, double dt,
                            Step& step) {
  if (!suction_) {
    suction_.emplace(goal_.suction, breaks_, monitor.noise());
    dent_force_ = monitor.force();
  }
  const int alarms = suction_->falseAlarms();
  const SuctionRun::Status status = suction_->step(monitor.reading(), interface_, injector, dt);
  result_.false_breaks += suction_->falseAlarms() - alarms;
  const auto end = [&step](InjectionOutcome outcome, const std::string& reason) {
    step.stop = outcome;
    step.reason = reason;
  };
  switch (status) {
    case SuctionRun::Status::kUnderWay:
      return;
    case SuctionRun::Status::kBroken:
      result_.break_suction = suction_->suction();
      return countPuncture(monitor, dent_force_, step);
    case SuctionRun::Status::kWhole:
      drew_ = true;
      if (goal_.break_by == BreakBy::kSuctionThenForce) {
        step.event = InjectionEvent::kIndent;
        return;
      }
      return end(InjectionOutcome::kNotPunctured, "the membrane withstands the largest suction");
    case SuctionRun::Status::kTooMuch:
      return end(InjectionOutcome::kNotPunctured,
                 "the interface has come as far as suction may draw it, and has gone back");
    case SuctionRun::Status::kNoWord:
      return end(InjectionOutcome::kNotPunctured,
                 "the witnesses have told a break that they do not confirm: the membrane may be open");
    case SuctionRun::Status::kBlind:
      return end(
          InjectionOutcome::kNotPunctured,
          "nothing could tell that suction breaks the membrane: the force in the dent is within its noise, and no "
          "image shows the interface");
    case SuctionRun::Status::kInjector:
      const bool refuses = injector && !injector->refusal.empty();
      return end(refuses ? InjectionOutcome::kNotInjected : InjectionOutcome::kInjectorTimeOut,
                 refuses    ? "the injector refused the suction: " + injector->refusal
                 : injector ? "the injector does not draw as it is told"
                            : "no valid state of the injector");
  }
}

void InjectionRun::countPuncture(const NeedleMonitor& monitor, double force, Step& step) {
  ++result_.punctures;
  layer_travel_ = travel_;
  result_.puncture_force = force;
  result_.puncture_depth = monitor.depth();
  step.event = InjectionEvent::kPuncture;
}

void InjectionRun::through(const NeedleMonitor& monitor, double dt, Step& step) {
  if (result_.punctures < goal_.layers) {
    step.event = InjectionEvent::kIndent;
    return;
  }
  travel_ = std::min(end_travel_, travel_ + std::min(config_.indent_speed, speed_limit_) * dt);
  const bool there = monitor.depth() >= end_travel_ - touch_travel_ - kArrived;
  if (travel_ < end_travel_ || !(there || state_time_ > kSettling)) return;
  const bool injects = goal_.pulse.duration > 0 && !injected_;
  if (injects) {
    if (mayProceed(InjectionEvent::kInject)) step.event = InjectionEvent::kInject;
    return;
  }
  awaits_command_ = !automatic_;
  rested_ += dt;
  if (automatic_ && rested_ >= goal_.hold_time) beginWithdrawal(done(), "", step);
}

void InjectionRun::inject(const std::optional<InjectorReport>& injector, double dt, Step& step) {
  const InjectorWait::Status status = wait_.step(injector, dt);
  result_.volume = wait_.volume();
  if (status == InjectorWait::Status::kOver) {
    injected_ = true;
    step.event = InjectionEvent::kInjected;
  }
  if (status == InjectorWait::Status::kBroken) {
    return beginWithdrawal(InjectionOutcome::kNotInjected, "the pulse was aborted or delivered less than its volume",
                           step);
  }
  if (status == InjectorWait::Status::kRefused) {
    return beginWithdrawal(InjectionOutcome::kNotInjected, "the injector refused the pulse: " + injector->refusal,
                           step);
  }
  if (status != InjectorWait::Status::kTimeOut) return;
  if (injector) return beginWithdrawal(InjectionOutcome::kInjectorTimeOut, "the injector has not finished", step);
  step.stop = InjectionOutcome::kInjectorTimeOut;
  step.reason = "no valid state of the injector";
}

void InjectionRun::retract(double dt, Step& step) {
  travel_ = std::max(0.0, travel_ - std::min(config_.retract_speed, speed_limit_) * dt);
  if (travel_ > 0) return;
  const bool releases = active_ && goal_.holding.release && holding_ && !released_ && isDone(outcome_);
  step.event = releases ? InjectionEvent::kRelease : InjectionEvent::kOut;
  if (releases) return;
  if (goal_.holding.release && !released_) reason_ += (reason_.empty() ? "" : "; ") + std::string(kStillHeld);
  end(outcome_, reason_);
}

void InjectionRun::holdCell(Step& step) {
  const std::string& failure = holding_->failure().empty() ? holding_->loss() : holding_->failure();
  const bool taken = holding_->phase() == Holding::Phase::kHeld;
  if (holding_->phase() == Holding::Phase::kFailed || (taken && !failure.empty())) {
    step.event = InjectionEvent::kOut;  // the needle has not moved
    end(InjectionOutcome::kNotHeld, failure);
  } else if (taken && mayProceed(InjectionEvent::kStart)) {
    step.event = InjectionEvent::kStart;
  }
}

void InjectionRun::releaseCell(Step& step) {
  if (!released_) {
    released_ = mayProceed(InjectionEvent::kRelease);
    step.releases = released_;
    return;
  }
  if (holding_->phase() == Holding::Phase::kReleasing) return;
  step.event = InjectionEvent::kOut;
  if (reason_.empty()) reason_ = holding_->failure();
  end(outcome_, reason_);
}

}  // namespace microinjection
