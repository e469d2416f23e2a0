#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/expected_puncture.h"
#include "operation/control/guards.h"
#include "operation/control/holding.h"
#include "operation/control/injection_goal.h"
#include "operation/control/injection_state.h"
#include "operation/control/injector_wait.h"
#include "operation/control/needle_monitor.h"
#include "operation/control/suction_run.h"

namespace microinjection {

/// Parameters of the motion of an injection.
///
/// The stab: a cell's force rises with the needle's speed and its membrane fails at a force, so a
/// fast needle deforms it least. But the needle moves on after the puncture until it is detected.
/// Its speed is such that it moves on by at most `overshoot` if the membrane fails now: overshoot /
/// (latency of the puncture detector at the present force + stop_time), between indent_speed and
/// stab_speed. It starts slowly, while noise would hide a puncture, and slows down only to stop
/// before the goal's depth. Where the puncture is expected, its force counts from the start: a fall
/// from the low end of its interval is detected earlier.
struct InjectionMotionConfig {
  double approach_speed = 20e-6;    ///< m/s, until contact
  double travel_limit = 60e-6;      ///< m, longest approach without contact
  double indent_speed = 5e-6;       ///< m/s, smallest speed in the cell
  double stab_speed = 200e-6;       ///< m/s, largest speed; equal to indent_speed: no stab
  double stab_acceleration = 5e-3;  ///< m/s^2
  double overshoot = 3e-6;          ///< m, travel after a puncture; half of it before a further membrane
  double stop_time = 10e-3;         ///< s, from a resting set-point to a resting needle (the rig's)
  double retract_speed = 20e-6;     ///< m/s, back to the start
  double injector_timeout = 1;      ///< s after the end of its pulse

  static InjectionMotionConfig read(ConfigReader& reader);
};

/// One injection along the pipette's axis without a hand: wait for the holding pipette to take the cell, approach until
/// contact, confirm it, indent until the puncture, or to a dent in which suction breaks the membrane, inject, withdraw,
/// wait until the cell is let go. Each step returns
/// the target of the tip and an event; the caller keeps the state.
class InjectionRun {
 public:
  struct Step {
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< m, `world`
    std::optional<InjectionEvent> event;
    std::optional<InjectionOutcome> stop;  ///< hold, and end with this outcome
    std::string reason;                    ///< of `stop`
    bool releases = false;                 ///< the holding pipette shall let the cell go
  };

  /// `automatic` = false: waits for confirm() in contact, at depth and after the injection.
  InjectionRun(const InjectionMotionConfig& config, const GuardConfig& guards, const ExpectationConfig& expectation,
               const BreakDetectionConfig& breaks, bool automatic);

  void start(const InjectionGoal& goal, const Eigen::Vector3d& tip);
  /// The operator's command for the next step (start, indent, aspirate, inject, release). Returns empty, or the reason
  /// for the refusal.
  std::string confirm(InjectionEvent event, InjectionState state);
  void limitSpeed(double speed) { speed_limit_ = speed; }  ///< m/s
  /// Of the outermost membrane; empty: nothing is expected. Call before each step.
  void expect(const std::optional<ExpectedPuncture>& expected) { expected_ = expected; }
  /// The interface in the needle's bore; empty: no image shows it. Call before each step.
  void see(const std::optional<InterfaceReading>& interface) { interface_ = interface; }
  /// What the holding pipette does. Call before each step.
  void see(const Holding& holding) { holding_ = &holding; }
  /// After a rest: a stab starts slowly again, and suction from nothing. A break that is being confirmed is confirmed
  /// first, because the membrane may be open.
  void restart() {
    speed_ = 0;
    if (suction_ && !suction_->confirms()) suction_.reset();
  }
  /// The withdrawal begins; the outcome is that of the completed steps.
  void withdraw();
  void end(InjectionOutcome outcome, const std::string& reason);

  /// Call after dt (s) in `state`, when the monitor has this step's force and needle. `setpoint`:
  /// m, the last; `axis`: unit, out of the cell. In the state withdraw it withdraws the needle also
  /// after the end (by a guard).
  Step step(InjectionState state, const NeedleMonitor& monitor, const std::optional<InjectorReport>& injector,
            const Eigen::Vector3d& setpoint, const Eigen::Vector3d& axis, double dt);

  /// Waits dt (s) in `state`. Returns empty, or the time guard's reason.
  std::string wait(InjectionState state, double dt);

  /// Pa, gauge, of the suction wanted now; empty: none.
  std::optional<double> suctionPressure() const { return suction_ ? suction_->pressure() : std::nullopt; }
  bool active() const { return active_; }
  bool awaitsCommand() const { return awaits_command_; }  ///< of the operator
  const InjectionGoal& goal() const { return goal_; }
  const InjectionResult& result() const { return result_; }

 private:
  void enter(InjectionState state, const NeedleMonitor& monitor);
  void approach(const NeedleMonitor& monitor, double dt, Step& step);
  void contact(const NeedleMonitor& monitor, Step& step);
  void indent(const NeedleMonitor& monitor, double dt, Step& step);
  void aspirate(const NeedleMonitor& monitor, const std::optional<InjectorReport>& injector, double dt, Step& step);
  bool drawsNext() const;
  bool drawsFirst() const { return drawsNext() && goal_.break_by != BreakBy::kForceThenSuction; }
  void through(const NeedleMonitor& monitor, double dt, Step& step);
  void inject(const std::optional<InjectorReport>& injector, double dt, Step& step);
  void retract(double dt, Step& step);
  void holdCell(Step& step);
  void releaseCell(Step& step);
  std::optional<ExpectedPuncture> expected() const;  ///< of the next membrane
  std::string unexpected(const NeedleMonitor& monitor) const;
  double stabSpeed(const NeedleMonitor& monitor, double dt) const;
  void countPuncture(const NeedleMonitor& monitor, double force, Step& step);
  bool mayProceed(InjectionEvent event);
  InjectionOutcome done() const;
  void beginWithdrawal(InjectionOutcome outcome, const std::string& reason, Step& step);

  InjectionMotionConfig config_;
  GuardConfig guards_;
  ExpectationConfig expectation_;
  BreakDetectionConfig breaks_;
  bool automatic_;
  std::optional<ExpectedPuncture> expected_;
  std::optional<InterfaceReading> interface_;
  const Holding* holding_ = nullptr;  ///< null: there is no holder; then no state waits for it
  InjectionGoal goal_;
  InjectionResult result_;
  bool active_ = false, awaits_command_ = false;
  InjectionState state_ = InjectionState::kIdle;
  double state_time_ = 0;                                         ///< s
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();               ///< m
  double travel_ = 0;                                             ///< m, from start_ into the cell
  double touch_travel_ = 0;                                       ///< m
  double layer_travel_ = 0;                                       ///< m, where the present membrane begins
  double end_travel_ = 0;                                         ///< m, of the state
  double speed_ = 0;                                              ///< m/s
  double speed_limit_ = std::numeric_limits<double>::infinity();  ///< m/s, of the rig
  double rested_ = 0;                                             ///< s, at end_travel_
  std::optional<InjectionEvent> confirmed_;
  InjectionOutcome outcome_ = InjectionOutcome::kNone;  ///< of the completed steps; the result's when the needle is out
  std::string reason_;
  bool injected_ = false;
  bool released_ = false;              ///< the cell, by the holding pipette
  std::optional<SuctionRun> suction_;  ///< under way
  double dent_force_ = 0;              ///< N, before it
  bool drew_ = false;                  ///< the last membrane has withstood it
  InjectorWait wait_;
};

}  // namespace microinjection
