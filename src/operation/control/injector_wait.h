#pragma once

#include <optional>

#include "operation/control/injection_goal.h"

namespace microinjection {

/// Waits for the end of an injector's pulse: its time is over, or its volume reached. A pulse that was broken off, or
/// whose time was over with less than its volume, is kBroken.
class InjectorWait {
 public:
  enum class Status { kWaiting, kOver, kBroken, kTimeOut };

  /// `patience` (s): beyond the pulse's duration, before the injector is given up.
  void start(const PulseGoal& pulse, double patience) {
    *this = {};
    pulse_ = pulse;
    patience_ = patience;
  }

  /// After another dt (s); `report` empty: nothing valid is known of the injector.
  Status step(const std::optional<InjectorReport>& report, double dt) {
    waited_ += dt;
    if (report) {
      if (!before_) before_ = report->volume;
      volume_ = report->volume - *before_;
      if (pulse_.volume > 0 && volume_ >= pulse_.volume) return Status::kOver;
      if (worked_ && !report->busy) return complete(*report) ? Status::kOver : Status::kBroken;
      worked_ = worked_ || report->busy;
    }
    return waited_ > pulse_.duration + patience_ ? Status::kTimeOut : Status::kWaiting;
  }

  double volume() const { return volume_; }  ///< m^3, since the start

 private:
  bool complete(const InjectorReport& report) const {
    constexpr double kEnough = 0.95;  // of a volume, that is no cause for alarm
    return pulse_.volume > 0 ? volume_ >= kEnough * pulse_.volume : report.done;
  }

  PulseGoal pulse_;
  double patience_ = 0;           ///< s
  double waited_ = 0;             ///< s
  std::optional<double> before_;  ///< m^3, of the first report
  double volume_ = 0;
  bool worked_ = false;
};

}  // namespace microinjection
