#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/control/guards.h"
#include "operation/control/injection_goal.h"
#include "operation/control/injection_state.h"
#include "operation/control/injector_wait.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {

/// How the needle moves of the controller's own.
///
/// The stab. A cell's force rises with the speed of the needle and its membrane fails by force, so a fast needle
/// deforms least; but what is through goes on until that is felt. So the needle is as fast as lets it go on for
/// `overshoot` at the most, were the membrane to fail now: overshoot / (latency of the puncture detector at the present
/// force + stop_time), between indent_speed and stab_speed. It starts slowly, where noise hides a puncture, and never
/// slows down but to stop before the goal's depth.
struct InjectionMotionConfig {
  double approach_speed = 20e-6;    ///< m/s, until the cell is touched
  double travel_limit = 60e-6;      ///< m, to look for the cell in before giving up
  double indent_speed = 5e-6;       ///< m/s, the slowest in the cell
  double stab_speed = 200e-6;       ///< m/s, the fastest; equal to indent_speed: no stab
  double stab_acceleration = 5e-3;  ///< m/s^2
  double overshoot = 3e-6;          ///< m that the needle may go on when it is through; half with a membrane behind
  double stop_time = 10e-3;         ///< s, from a set-point that rests to a needle that rests (the rig's)
  double retract_speed = 20e-6;     ///< m/s, back to the start
  double injector_timeout = 1;      ///< s beyond its pulse that the injector may take

  static InjectionMotionConfig read(ConfigReader& reader);
};

/// One injection along the pipette's axis without a hand: approach until the cell is touched, look again, indent until
/// the membrane is through, inject, withdraw. Each step says where the tip shall be and what happened; whose state it
/// is, is the caller's.
class InjectionRun {
 public:
  struct Step {
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< m, `world`
    std::optional<InjectionEvent> event;
    std::optional<InjectionOutcome> stop;  ///< hold, and end with this
    std::string reason;                    ///< of `stop`
  };

  /// `automatic`: false: waits in contact, at depth and when injected for `confirm`.
  InjectionRun(const InjectionMotionConfig& config, const GuardConfig& guards, bool automatic);

  void start(const InjectionGoal& goal, const Eigen::Vector3d& tip);
  /// The operator's word for the next step (indent, inject); empty when it is one now, otherwise why not.
  std::string confirm(InjectionEvent event, InjectionState state);
  void limitSpeed(double speed) { fastest_ = speed; }  ///< m/s, never faster than that
  void rested() { speed_ = 0; }                        ///< the needle has: a stab sets out slowly again
  void withdraw();  ///< the way out is taken; the outcome is that of what was done until now
  void end(InjectionOutcome outcome, const std::string& reason);

  /// After dt (s) in `state`; the monitor has seen this step's force and needle. `setpoint`: m, the last; `axis`: unit,
  /// out of the cell. In the state withdraw it leads out also when it is over (after a guard).
  Step step(InjectionState state, const NeedleMonitor& monitor, const std::optional<InjectorReport>& injector,
            const Eigen::Vector3d& setpoint, const Eigen::Vector3d& axis, double dt);

  /// dt (s) in which nothing could be done in `state`; empty, or why that is too long.
  std::string wait(InjectionState state, double dt);

  bool active() const { return active_; }
  bool waits() const { return awaits_command_; }  ///< for the operator
  const InjectionGoal& goal() const { return goal_; }
  const InjectionResult& result() const { return result_; }

 private:
  void enter(InjectionState state, const NeedleMonitor& monitor);
  void approach(const NeedleMonitor& monitor, double dt, Step& step);
  void contact(const NeedleMonitor& monitor, Step& step);
  void indent(const NeedleMonitor& monitor, double dt, Step& step);
  void goToDepth(const NeedleMonitor& monitor, double dt, Step& step);
  void through(const NeedleMonitor& monitor, double dt, Step& step);
  void inject(const std::optional<InjectorReport>& injector, double dt, Step& step);
  void retract(double dt, Step& step);
  double stabSpeed(const NeedleMonitor& monitor, double dt) const;
  void countPuncture(const NeedleMonitor& monitor, Step& step);
  bool goOn(InjectionEvent event);
  InjectionOutcome done() const;
  void leave(InjectionOutcome outcome, const std::string& reason, Step& step);

  InjectionMotionConfig config_;
  GuardConfig guards_;
  bool automatic_;
  InjectionGoal goal_;
  InjectionResult result_;
  bool active_ = false, awaits_command_ = false;
  InjectionState state_ = InjectionState::kIdle;
  double in_state_ = 0;                                       ///< s
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();           ///< m
  double travel_ = 0;                                         ///< m, from start_ into the cell
  double touch_travel_ = 0;                                   ///< m
  double end_travel_ = 0;                                     ///< m, of the state
  double speed_ = 0;                                          ///< m/s
  double fastest_ = std::numeric_limits<double>::infinity();  ///< m/s, that the rig can be driven at
  double rested_ = 0;                                         ///< s, at end_travel_
  std::optional<InjectionEvent> confirmed_;
  InjectionOutcome outcome_ = InjectionOutcome::kNone;  ///< of what was done; the result's when the needle is out
  std::string reason_;
  bool injected_ = false;
  InjectorWait wait_;
};

}  // namespace microinjection
