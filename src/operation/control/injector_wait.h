#pragma once

#include <optional>

#include "operation/control/injection_goal.h"

namespace microinjection {

/// Waits for the end of an injector's pulse: its time is over, or its volume delivered. A pulse
/// that was aborted, or ended with less than its volume, is kBroken. One that the injector has refused never begins.
class InjectorWait {
 public:
  enum class Status { kWaiting, kOver, kBroken, kRefused, kTimeOut };

  /// `timeout` (s): after the pulse's duration.
  void start(const PulseGoal& pulse, double timeout) {
    *this = {};
    pulse_ = pulse;
    timeout_ = timeout;
  }

  /// Advances by dt (s); `report` empty: no valid state of the injector.
  Status step(const std::optional<InjectorReport>& report, double dt) {
    waiting_time_ += dt;
    if (report && !report->refusal.empty()) return Status::kRefused;
    if (report) {
      if (!before_) before_ = report->volume;
      volume_ = report->volume - *before_;
      if (pulse_.volume > 0 && volume_ >= pulse_.volume) return Status::kOver;
      if (worked_ && !report->busy) return complete(*report) ? Status::kOver : Status::kBroken;
      worked_ = worked_ || report->busy;
    }
    return waiting_time_ > pulse_.duration + timeout_ ? Status::kTimeOut : Status::kWaiting;
  }

  double volume() const { return volume_; }  ///< m^3, since the start

 private:
  bool complete(const InjectorReport& report) const {
    constexpr double kEnough = 0.95;  // share of the volume that counts as complete
    return pulse_.volume > 0 ? volume_ >= kEnough * pulse_.volume : report.done;
  }

  PulseGoal pulse_;
  double timeout_ = 0;            ///< s
  double waiting_time_ = 0;       ///< s
  std::optional<double> before_;  ///< m^3, of the first report
  double volume_ = 0;
  bool worked_ = false;
};

}  // namespace microinjection
