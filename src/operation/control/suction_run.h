#pragma once

#include <optional>
#include <string>

#include "operation/control/break_detector.h"
#include "operation/control/injection_goal.h"

namespace microinjection {

/// Suction in the needle until the membrane before its mouth breaks, with the needle at rest:
///
///     rest ---> draw: the suction grows --- an alarm ---> confirm: no suction --- broken ---> over
///                 ^          |                               |
///                 |          | at the largest for `time`     | not broken
///                 |          v                               |
///                 |        over: whole                       |
///                 '------------------------------------------'
///
/// The suction ends with the alarm and not with its confirmation: what it draws in too much, it draws in meanwhile.
class SuctionRun {
 public:
  enum class Status {
    kUnderWay,
    kBroken,
    kWhole,     ///< at the largest suction, for its time
    kTooMuch,   ///< the interface is where it ends, and has gone back
    kNoWord,    ///< too many alarms that were false, or one that nobody can confirm: it may be broken
    kBlind,     ///< no witness could tell a break
    kInjector,  ///< it does not report, refuses, or does not draw as it is told
  };

  SuctionRun(const SuctionGoal& goal, const BreakDetectionConfig& config, double force_noise)
      : goal_(goal), detector_(config, force_noise) {}

  /// Advances by dt (s). `force`: N, along the pipette above the offset, of a new reading.
  Status step(const std::optional<double>& force, const std::optional<InterfaceReading>& interface,
              const std::optional<InjectorReport>& injector, double dt);

  /// Pa, gauge, wanted of the injector now; empty: no suction.
  std::optional<double> pressure() const;
  /// The suction has ended and a break is being confirmed: it must not draw again before that.
  bool confirms() const { return confirming_; }
  double suction() const { return drawn_; }                ///< Pa, of the injector, when the last alarm came
  const std::string& witness() const { return witness_; }  ///< that told the break
  int falseAlarms() const { return false_alarms_; }

 private:
  Status confirm(const std::optional<double>& force, const std::optional<InterfaceReading>& interface, double dt);
  bool obeyed(const std::optional<InjectorReport>& injector, double dt);
  void rest();

  SuctionGoal goal_;
  BreakDetector detector_;
  double time_ = 0;     ///< s, at rest, then at the largest suction
  double drawing_ = 0;  ///< s
  bool feels_ = false;  ///< the force has been read
  bool confirming_ = false;
  double suction_ = 0;             ///< Pa
  std::optional<double> balance_;  ///< Pa, gauge, of the injector before the suction
  bool too_far_ = false;           ///< the interface has been at its end
  double drawn_ = 0;               ///< Pa
  double disobeyed_ = 0;           ///< s, in which the injector did not draw as it was told
  double silent_ = 0;              ///< s without a report of the injector
  std::string witness_;
  int false_alarms_ = 0;
};

}  // namespace microinjection
