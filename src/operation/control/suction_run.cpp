#include "operation/control/suction_run.h"

#include <algorithm>

namespace microinjection {
namespace {

constexpr double kRest = 0.15;   ///< s before the suction, in which the witnesses see the membrane at rest
constexpr double kSilent = 0.2;  ///< s, past which an injector that does not report is lost
constexpr int kMostAlarms = 5;

}  // namespace

SuctionRun::Status SuctionRun::step(const std::optional<double>& force,
                                    const std::optional<InterfaceReading>& interface,
                                    const std::optional<InjectorReport>& injector, double dt) {
  silent_ = injector && injector->refusal.empty() ? 0 : silent_ + dt;
  if (silent_ > kSilent) return Status::kInjector;
  std::optional<double> flow;
  if (injector) {
    if (!balance_) balance_ = injector->pressure;
    flow = -injector->flow;
  }
  if (confirming_) {
    const std::optional<bool> broken = detector_.confirm(force, interface, dt);
    if (!broken) return Status::kUnderWay;
    if (*broken) return Status::kBroken;
    if (too_far_) return Status::kTooMuch;
    if (++false_alarms_ > kMostAlarms) return Status::kNoWord;
    confirming_ = false;
    time_ = 0;
    detector_.resume();
  }
  time_ += dt;
  const std::string alarm = detector_.watch(force, interface, flow, dt);
  const bool rests = time_ <= kRest;
  if (!rests) {
    suction_ = goal_.rate > 0 ? std::min(goal_.largest, suction_ + goal_.rate * dt) : goal_.largest;
    if (suction_ < goal_.largest) time_ = kRest;  // the time at the largest suction has not begun
  }
  too_far_ = interface && interface->position >= goal_.length;
  if (too_far_ || (!rests && !alarm.empty())) {
    witness_ = alarm.empty() ? "image" : alarm;
    confirming_ = true;
    return Status::kUnderWay;
  }
  return time_ > kRest + goal_.time ? Status::kWhole : Status::kUnderWay;
}

std::optional<double> SuctionRun::pressure() const {
  if (confirming_ || time_ < kRest || suction_ == 0 || !balance_) return std::nullopt;
  return *balance_ - suction_;
}

}  // namespace microinjection
