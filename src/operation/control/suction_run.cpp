#include "operation/control/suction_run.h"

#include <algorithm>

namespace microinjection {
namespace {

constexpr double kRest = 0.15;      ///< s before the suction, in which the witnesses see the membrane at rest
constexpr double kLongestRest = 1;  ///< s, for the force of a slow loop: its samples come one a step
constexpr double kSilent = 0.2;     ///< s, past which an injector that does not report is lost
constexpr double kObeys = 0.5;      ///< s, within which an injector draws as it is told
constexpr double kEnough = 0.5;     ///< share of the wanted suction that is drawn by then
constexpr double kLeap = 0.1;       ///< s, after which a tongue rests that was drawn in at once
constexpr int kMostAlarms = 5;

}  // namespace

SuctionRun::Status SuctionRun::step(const std::optional<double>& force,
                                    const std::optional<InterfaceReading>& interface,
                                    const std::optional<InjectorReport>& injector, double dt) {
  silent_ = injector && injector->refusal.empty() ? 0 : silent_ + dt;
  if (silent_ > kSilent) return Status::kInjector;
  const std::optional<double> flow = injector ? std::optional(-injector->flow) : std::nullopt;
  if (confirming_) return confirm(force, interface, dt);
  time_ += dt;
  feels_ = feels_ || force;
  const bool rests = drawing_ == 0 && (time_ <= kRest || (feels_ && !detector_.knowsForce() && time_ <= kLongestRest));
  if (rests && injector && !injector->busy) balance_ = injector->pressure;
  // A step of the suction moves a tongue at once: no run of the interface.
  const bool leaps = goal_.rate == 0 && !rests && drawing_ < kLeap;
  const std::string alarm = detector_.watch(force, leaps ? std::optional<InterfaceReading>() : interface, flow, dt);
  if (rests) {
    if (!alarm.empty()) rest();
    return Status::kUnderWay;
  }
  if (drawing_ == 0 && !detector_.canTell()) return Status::kBlind;
  if (drawing_ == 0) time_ = kRest;
  drawing_ += dt;
  suction_ = goal_.rate > 0 ? std::min(goal_.largest, suction_ + goal_.rate * dt) : goal_.largest;
  if (suction_ < goal_.largest) time_ = kRest;  // the time at the largest suction has not begun
  if (!obeyed(injector, dt)) return Status::kInjector;
  too_far_ = interface && interface->position >= goal_.length;
  if (!too_far_ && alarm.empty()) return time_ > kRest + goal_.time ? Status::kWhole : Status::kUnderWay;
  witness_ = alarm.empty() ? "image" : alarm;
  if (injector && balance_) drawn_ = *balance_ - injector->pressure;
  confirming_ = true;
  return Status::kUnderWay;
}

/// Whether the injector has drawn about as it is told within some time.
bool SuctionRun::obeyed(const std::optional<InjectorReport>& injector, double dt) {
  if (!balance_) return false;  // it was busy with something else all the time
  if (!injector) return true;   // see silent_
  const bool draws = injector->busy && *balance_ - injector->pressure > kEnough * suction_;
  disobeyed_ = draws ? 0 : disobeyed_ + dt;
  return disobeyed_ <= kObeys;
}

SuctionRun::Status SuctionRun::confirm(const std::optional<double>& force,
                                       const std::optional<InterfaceReading>& interface, double dt) {
  const std::optional<BreakDetector::Verdict> verdict = detector_.confirm(force, interface, dt);
  if (!verdict) return Status::kUnderWay;
  if (*verdict == BreakDetector::Verdict::kBroken) return Status::kBroken;
  if (*verdict == BreakDetector::Verdict::kUnknown) return Status::kNoWord;
  if (too_far_) return Status::kTooMuch;
  if (++false_alarms_ > kMostAlarms) return Status::kNoWord;
  rest();
  return Status::kUnderWay;
}

/// Begins anew with the membrane at rest.
void SuctionRun::rest() {
  detector_.resume();
  confirming_ = false;
  time_ = drawing_ = suction_ = disobeyed_ = 0;
}

std::optional<double> SuctionRun::pressure() const {
  if (confirming_ || suction_ == 0 || !balance_) return std::nullopt;
  return *balance_ - suction_;
}

}  // namespace microinjection
