#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "base/operating_state.h"
#include "operation/control/expected_puncture.h"
#include "operation/control/force_witness.h"
#include "operation/control/guards.h"
#include "operation/control/hand_observer.h"
#include "operation/control/holding.h"
#include "operation/control/injection_goal.h"
#include "operation/control/injection_run.h"
#include "operation/control/injection_state.h"
#include "operation/control/needle_monitor.h"
#include "operation/control/withdrawal_guard.h"

namespace microinjection {

struct InjectionControllerConfig {
  /// manual: follows /teleop/servo_cp; semi_automatic: moves by itself, each step on the operator's
  /// command; automatic: moves by itself
  std::string mode = "manual";
  bool start_when_enabled = true;  ///< automatic: starts `goal` when it is enabled
  GuardConfig guards;
  DetectionConfig detection;
  InjectionMotionConfig motion;
  ExpectationConfig expectation;
  WitnessConfig witness;
  BreakDetectionConfig break_detection;
  bool holder = false;  ///< there is one, whose pressure is commanded
  HoldingConfig holding;
  InjectionGoal goal;  ///< for injections started without one

  static InjectionControllerConfig read(ConfigReader& reader);
};

/// Controls the needle's set-point: follows the hand's target or moves by itself, within the guards.
///
///     Input --> valid? rig follows? --> observe(): NeedleMonitor, ForceWitness --> events --> injection()
///                    |                                                               ^
///                    |   manual:     the hand's target --> WithdrawalGuard -----.    '-- HandObserver (manual)
///                    '-> by itself:  guards --> InjectionRun -------------------+--> move(): speed, lag --> set-point
///                        home:       along the pipette, then across ------------'
///
/// The states of an injection do not depend on who moves the needle: by hand they are observed, and by the controller
/// they are brought about, but the table of transitions, the detection, the guards and the witnesses are the same
/// (doc/design/injection.md). A controller for each of the three modes would be simpler, and each would have its own
/// notion of a puncture; a guard that is mended in one would be missing in the others. For the same reason the
/// set-point advances in one function only, which knows the limits of speed and lag; others only take it back to the
/// needle.
///
/// The set-point stays with its needle. A set-point that went on while the needle is blocked, lags or is off would
/// make the needle leap through the cell once it is free; so it waits for a needle that does not follow, and is where
/// the needle is while the rig does not follow. What a guard refuses of the hand's motion is discarded, because the
/// needle must not catch up when the force falls in a puncture.
///
/// One force alone cannot tell a dead sensor from a needle that has not touched yet, or a misplaced model from a cell
/// that is not there. While the controller moves the needle by itself, it therefore asks the other force, the image
/// and the model of the cell (ForceWitness, Input::predicted_inside). By hand they hold nothing: the person sees and
/// feels more than they do.
///
/// Without a valid target, force or needle pose the controller holds the needle at its set-point. It moves the needle
/// only in the operating state ENABLED (CRTK). A hand's targets count from the needle's position when it was enabled,
/// resumed or held. injection() is valid in every mode. Reaction to the guards (the injection "stops": PAUSED,
/// outcome guard; allowed then are withdraw, home and disable):
///
///     guard               by hand                       by itself
///     force, depth        may only be withdrawn: see    stops, except during withdrawal
///                         WithdrawalGuard
///     expected puncture   -                             indent: stops
///     witnesses disagree  -                             stops; a pulse does not begin
///     time in a state     -                             stops, also during withdrawal
///     cell is not held    -                             stops, except during withdrawal
///     sensor at fault     PAUSED, a pulse ends          stops, except during withdrawal
///     no valid force      held meanwhile                indent, aspirate, inject: stops; withdraw:
///                                                       none; else held meanwhile
///     no valid needle     held meanwhile, a pulse ends  indent, aspirate, inject: stops; else held
///                                                       meanwhile, up to the time guard
///     needle does not     the set-point waits for it;   the set-point waits for it
///     follow              the hand's motion is ignored
///     rig does not        held meanwhile, a pulse       PAUSED, a pulse stops; stops if the needle
///     follow              ends                          is moved meanwhile
///     stale injector      its pulse counts as over      stops after pulse + injector_timeout
///     tracking, speed     FAULT: no set-point, until disable or enable
///     speed of set-point  never above the limit
class InjectionController {
 public:
  using Image = ForceWitness::Image;
  /// Valid inputs of this cycle; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> target;  ///< m, `world`
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;   ///< N, of the cell on the tip, `world`
    bool force_is_new = true;               ///< another reading than that of the last step
    std::optional<InjectorReport> injector;
    std::string rig_hold;                       ///< why the rig does not follow set-points; empty: it does
    std::optional<ExpectedPuncture> expected;   ///< of the outermost membrane
    std::optional<Eigen::Vector3d> witness;     ///< N, as `force`, of the source that it is not: see ForceWitness
    bool witness_is_new = true;                 ///< as force_is_new
    std::string witness_fault;                  ///< why it cannot be believed; empty: it can, or there is none
    std::optional<Image> image;                 ///< of the tip before the cell, when it is sure
    std::optional<InterfaceReading> interface;  ///< in the needle's bore, when an image shows it
    std::optional<HolderReport> holder;
    std::optional<HoldReport> cell_hold;              ///< when somebody sees it
    std::optional<bool> predicted_inside;             ///< whether the cell whose force is predicted is punctured
    bool cell_changed = false;                        ///< its force now is no event of the needle
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the pipette, out of the cell, `world`
  };

  /// @pre `config` is valid, as InjectionControllerConfig::read returns it
  explicit InjectionController(const InjectionControllerConfig& config);

  /// Executes a command. Returns empty, or the reason for the refusal; the state then stays.
  /// - enable, disable, pause, resume, home, unhome: CRTK's state_command with the table of
  ///   base/operating_state.h. home is also allowed in PAUSED.
  /// - home: withdraws the needle along the pipette, moves it across to where it was enabled, never
  ///   deeper than it is, and pauses. It needs no valid force.
  /// - unhome: ends an injection and holds the needle until home.
  /// - approach: starts the configured goal, or is the operator's next step when the cell is held. indent, aspirate,
  ///   inject: the operator's next step. By hand only inject is allowed.
  /// - hold: the holding pipette takes the cell. By itself it begins the configured goal, if that has a suction.
  ///   release: it lets the cell go, with the needle out of it. Both are allowed by hand.
  /// - withdraw: ends (preempts) an injection in any state and returns the needle to its start,
  ///   also after a guard, and from the cell after disable. After a pause by the operator the
  ///   needle is PAUSED again when it is out.
  ///
  /// Disabled and enabled again in the cell, depth, offset and home stay, and no injection starts
  /// there.
  std::string command(const std::string& command);
  /// As the command withdraw, without a notice: for programs, which use the returned reason.
  std::string withdraw();
  /// Starts an injection. Returns empty, or the reason for the refusal: in mode manual, in another state than ENABLED
  /// and idle, in the cell, after unhome, or with a goal beyond its limits.
  std::string start(const InjectionGoal& goal);

  /// Advances by dt (s, > 0). Returns the set-point of the needle (m, `world`); empty while DISABLED or in FAULT, and
  /// before the first valid pose of the needle.
  std::optional<Eigen::Vector3d> step(Input input, double dt);

  /// Adapts to a rig that is at most `speed` (m/s) fast and follows with a `lag` (s): the set-point
  /// is then never faster than lag_limit and the configuration allow. Returns empty, or why the
  /// values are implausible: then nothing changes.
  std::string adaptTo(double speed, double lag);
  double speedLimit() const { return std::min(rig_speed_, config_.guards.speed_limit); }  ///< m/s

  OperatingState state() const { return state_; }
  InjectionState injection() const { return injection_; }
  bool busy() const;                                           ///< moves by itself
  bool awaitsCommand() const { return run_.awaitsCommand(); }  ///< of the operator
  /// True from the first valid pose of the needle on, since axes are absolute; after unhome from
  /// home on.
  bool homed() const { return needle_valid_ && !unhomed_; }
  const std::string& holdReason() const { return hold_reason_; }  ///< empty while the needle follows
  /// Why a witness does not agree with the force that the controller acts on; empty: all do.
  std::string disagreement() const;
  bool followsTarget() const { return state_ == OperatingState::kEnabled && hold_reason_.empty(); }
  /// Why the last command was refused, or its pulse by hand ended early; else empty.
  const std::string& notice() const { return notice_; }
  const NeedleMonitor& monitor() const { return monitor_; }
  /// N along the pipette, of the last valid force, as the force guard compares it: the sensor's
  /// offset is in it.
  double guardForce() const { return guard_force_; }

  bool running() const { return run_.active(); }  ///< an injection is under way
  InjectionFeedback feedback() const;
  int punctures() const { return punctures_; }  ///< detected since the needle started
  double injectedVolume() const { return byHand() ? hand_pulse_.volume() : run_.result().volume; }  ///< m^3, since then
  const InjectionResult& result() const { return run_.result(); }  ///< final when not running()
  /// The pulse for the injector now, whose pressure may change while it lasts; a suction is one below the pressure
  /// between pulses. Empty: none, a pulse under way must stop.
  std::optional<PulseGoal> pulse() const;
  /// The pressure wanted in the mouth of the holding pipette; empty: nobody has asked for one.
  const std::optional<HolderCommand>& holderCommand() const { return holding_.command(); }
  const Holding& holding() const { return holding_; }

 private:
  bool byHand() const { return config_.mode == "manual"; }
  /// By hand: nobody moves the needle. The operator may have released it to send a command.
  static constexpr const char* kNoTarget = "no valid target";
  static constexpr const char* kNotHomed = "not homed; allowed after home";

  std::string execute(const std::string& command);
  std::string applyCommand(const std::string& text);
  std::string change(StateCommand command);
  std::string goHome();
  std::string applyOperatorCommand(InjectionEvent event);
  std::string holdCell();
  std::string releaseCell();
  void apply(InjectionEvent event);
  bool isInside(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis) const;
  void engage(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis);
  void invalidateNeedle(double dt);
  void refuseForce(Input& input);
  void yieldToRig(const Input& input);
  bool rigIsAtFault(const Eigen::Vector3d& needle, double dt);
  void monitorManualPulse(const Input& input, double dt);
  void observe(const Input& input, bool force_valid, double dt);
  void watchHold(const Input& input, double dt);
  void resetMonitors();
  std::string contradiction() const;
  void monitorPulse(const Input& input, double dt);
  std::optional<Eigen::Vector3d> handTarget(const Input& input);
  std::optional<Eigen::Vector3d> ownTarget(const Input& input, double dt);
  bool applyStep(const InjectionRun::Step& step);
  std::string guard(const Input& input) const;
  void hold(const std::string& reason);
  void stop(InjectionOutcome outcome, const std::string& reason);
  void stopNeedle(const Input& input);
  void endPulse(const std::string& reason);
  const char* blindWork() const;
  void stepHome(const Input& input, double dt);
  void holdUnhomed();
  void follow(const Eigen::Vector3d& target, const Input& input, double dt);
  void refuse(const Eigen::Vector3d& motion);
  bool move(const Eigen::Vector3d& motion, const Input& input, double dt);

  InjectionControllerConfig config_;
  OperatingState state_ = OperatingState::kDisabled;
  InjectionState injection_ = InjectionState::kIdle;
  NeedleMonitor monitor_;
  ForceWitness witness_;
  std::string witness_fault_;      ///< of the last step
  bool predicted_inside_ = false;  ///< the needle, in the cell whose force is predicted
  bool denies_puncture_ = false;   ///< the model of the predicted force has no puncture where the needle is
  double guard_force_ = 0;         ///< N
  WithdrawalGuard withdrawal_;     ///< by hand
  HandObserver observer_;
  InjectionRun run_;
  Holding holding_;
  InjectorWait hand_pulse_;
  bool pulse_by_hand_ = false;
  int punctures_ = 0;
  NeedleSpeed needle_speed_;
  std::optional<Eigen::Vector3d> setpoint_;                     ///< m; starts at the needle when it is enabled
  std::optional<Eigen::Vector3d> yielded_;                      ///< m, the needle when the rig began not to follow
  std::optional<Eigen::Vector3d> target_offset_;                ///< m, added to targets; set at the first one
  Eigen::Vector3d home_ = Eigen::Vector3d::Zero();              ///< m, the needle when it was enabled out of the cell
  double rig_speed_ = std::numeric_limits<double>::infinity();  ///< m/s
  double following_error_limit_;                                ///< m, largest distance of set-point and needle
  bool paused_ = false;                                         ///< by a person, not by a guard
  bool homing_ = false;
  bool unhomed_ = false;  ///< by command, until the needle is home again
  bool needle_valid_ = false;
  std::string sensor_fault_;  ///< empty: the force may be that of a cell
  std::string hold_reason_ = "DISABLED";
  std::string notice_;
};

}  // namespace microinjection
