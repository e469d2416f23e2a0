#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "base/operating_state.h"
#include "operation/control/guards.h"
#include "operation/control/hand_observer.h"
#include "operation/control/injection_goal.h"
#include "operation/control/injection_run.h"
#include "operation/control/injection_state.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {

struct InjectionControllerConfig {
  /// manual: follows /teleop/servo_cp; semi_automatic: moves by itself, step by step at the operator's word;
  /// automatic: the whole injection
  std::string mode = "manual";
  bool start_when_enabled = true;  ///< automatic: `goal` is begun as soon as it is enabled
  GuardConfig guards;
  DetectionConfig detection;
  InjectionMotionConfig motion;
  InjectionGoal goal;  ///< of injections that are started without one

  static InjectionControllerConfig read(ConfigReader& reader);
};

/// Decides where the needle goes: takes the hand's target or moves it by itself, and lets through only what is safe.
///
/// Without a valid target, force or needle pose it holds the needle where its set-point is. It moves the needle in
/// no operating state but ENABLED; a hand's targets count from where the needle was when it was enabled, resumed or
/// held. Where the injection is (injection()) is told in every mode. What guards do:
///
///     guard                by hand                            by itself
///     force, depth         may only be withdrawn, as long     PAUSED, the injection ends (outcome guard); what is left
///                          as it is beyond                    is withdraw, home and disable. Not while it withdraws
///     time in a state      -                                  same, while it withdraws as well
///     no valid force     held while it lasts                same while it indents or injects; else held while it
///                                                             lasts. It is not needed to withdraw
///     no valid needle    held while it lasts, a pulse ends  same while it indents or injects; else held while it
///                                                             lasts, for the time guard at the most
///     needle stands still  the set-point waits for it (leash) same; what a hand did meanwhile is forgotten
///     silent injector      its pulse counts as over           PAUSED, when the pulse and injector_timeout are over
///     tracking, speed      FAULT: no set-point, until disable or enable
///     speed of set-point   never above the limit
class InjectionController {
 public:
  /// What the controller can trust now; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> target;  ///< m, `world`
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;   ///< N, of the cell on the tip, `world`
    std::optional<InjectorReport> injector;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the pipette, out of the cell, `world`
  };

  explicit InjectionController(const InjectionControllerConfig& config);

  /// enable, disable, pause, resume, home, unhome (CRTK state_command; base/operating_state.h has the table, and home
  /// is allowed in PAUSED, too). home withdraws the needle along the pipette and takes it over where it was enabled,
  /// never deeper than it is, also without a valid force; then pauses: the way out when the needle is held. unhome
  /// ends what the controller does by itself and holds the needle until it is home. approach (starts the configured
  /// goal), indent, inject and withdraw are the operator's words to an injection: withdraw gives up (preempts) what the
  /// controller does by itself, in any state of it, and takes the needle back to where it set out, also after a guard
  /// and where it was left in the cell by disable; what a person has paused is PAUSED again when it is out. By hand
  /// there is only inject. Disabled in the cell and enabled again, depth, offset and home stay: no injection starts
  /// there. Empty when obeyed, otherwise the reason for the refusal; the state is then as before.
  std::string command(const std::string& command);
  /// As the word withdraw, but of a program, which looks at the refusal itself: no notice.
  std::string withdraw();
  /// Starts an injection of the controller's own; empty when begun, otherwise why not.
  std::string start(const InjectionGoal& goal);

  /// One cycle of dt (s): the set-point for the needle (m, `world`); empty while DISABLED or in FAULT.
  std::optional<Eigen::Vector3d> step(const Input& input, double dt);

  /// To a rig that is no faster than `speed` (m/s) and follows `lag` (s) late: never driven faster than lag_limit
  /// allows, nor than configured. Empty, or why no rig is like that: then nothing changes.
  std::string adaptTo(double speed, double lag);
  double speedLimit() const { return std::min(rig_speed_, config_.guards.speed_limit); }  ///< m/s

  OperatingState state() const { return state_; }
  InjectionState injection() const { return injection_; }
  bool busy() const;                           ///< moves of its own accord
  bool waits() const { return run_.waits(); }  ///< for the operator's word
  /// As soon as the needle's pose is known, since axes are absolute; after unhome when it is home again.
  bool homed() const { return needle_valid_ && !unhomed_; }
  const std::string& holdReason() const { return hold_reason_; }  ///< empty while the needle follows
  bool followsTarget() const { return state_ == OperatingState::kEnabled && hold_reason_.empty(); }
  /// Why the last command was refused, or the pulse by hand that it asked for is over too early; else empty.
  const std::string& notice() const { return notice_; }
  const NeedleMonitor& monitor() const { return monitor_; }

  bool running() const { return run_.active(); }  ///< an injection of the controller's own is not over yet
  InjectionFeedback feedback() const;
  int punctures() const { return punctures_; }  ///< membranes whose failure was felt since the needle set out
  double injectedVolume() const { return byHand() ? hand_pulse_.volume() : run_.result().volume; }  ///< m^3, same
  const InjectionResult& result() const { return run_.result(); }  ///< final when not running()
  /// The pulse that the injector is to deliver now; empty: none, and one that is under way is to be stopped.
  std::optional<PulseGoal> pulse() const;

 private:
  bool byHand() const { return config_.mode == "manual"; }
  /// By hand: nobody leads the needle. Its operator may have let go to say something.
  static constexpr const char* kNoTarget = "no valid target";
  static constexpr const char* kNotHomed = "not homed; allowed after home";

  std::string execute(const std::string& command);
  std::string applyCommand(const std::string& word);
  std::string change(StateCommand command);
  std::string goHome();
  std::string applyOperatorCommand(InjectionEvent event);
  void apply(InjectionEvent event);
  bool isInside(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis) const;
  void engage(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis);
  void invalidateNeedle(double dt);
  bool rigIsAtFault(const Eigen::Vector3d& needle, double dt);
  void monitorManualPulse(const Input& input, double dt);
  void observe(const Input& input, bool force_trusted, double dt);
  void monitorPulse(const Input& input, double dt);
  std::optional<Eigen::Vector3d> handTarget(const Input& input);
  std::optional<Eigen::Vector3d> ownTarget(const Input& input, double dt);
  bool take(const InjectionRun::Step& step);
  std::string guard(const Input& input) const;
  void hold(const std::string& reason);
  void stop(InjectionOutcome outcome, const std::string& reason);
  void stopNeedle(const Input& input);
  void endPulse(const std::string& why);
  void stepHome(const Input& input, double dt);
  void holdUnhomed();
  void follow(const Eigen::Vector3d& target, const Input& input, double dt);
  void refuse(const Eigen::Vector3d& motion);
  bool move(const Eigen::Vector3d& motion, const Input& input, double dt);

  InjectionControllerConfig config_;
  OperatingState state_ = OperatingState::kDisabled;
  InjectionState injection_ = InjectionState::kIdle;
  NeedleMonitor monitor_;
  HandObserver observer_;
  InjectionRun run_;
  InjectorWait hand_pulse_;
  bool pulse_by_hand_ = false;
  int punctures_ = 0;
  NeedleSpeed needle_speed_;
  std::optional<Eigen::Vector3d> setpoint_;         ///< m; taken from the needle when it is enabled
  std::optional<Eigen::Vector3d> target_offset_;    ///< m, added to targets; taken with the first one once enabled
  Eigen::Vector3d home_ = Eigen::Vector3d::Zero();  ///< m, where the needle was enabled out of the cell
  double rig_speed_ = std::numeric_limits<double>::infinity();  ///< m/s
  double following_error_limit_;                                ///< m, that the set-point may be ahead of the needle
  bool limited_ = false;  ///< by hand: a guard was past its limit in the last step
  bool paused_ = false;   ///< by a person, not by a guard
  bool homing_ = false;
  bool unhomed_ = false;  ///< by command, until the needle is home again
  bool needle_valid_ = false;
  std::string hold_reason_ = "DISABLED";
  std::string notice_;
};

}  // namespace microinjection
