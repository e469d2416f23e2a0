#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "control/approach.h"

namespace microinjection {

struct InjectionControllerConfig {
  std::string source = "teleop";  ///< teleop: follow /teleop/servo_cp; approach: the controller's own
  double speed_limit = 200e-6;    ///< m/s, of the set-point
  double jump_limit = 100e-6;     ///< m, a target farther than this from the set-point is not followed
  double tracking_limit = 50e-6;  ///< m between needle and set-point past which the rig is at fault
  double force_limit = 15e-6;     ///< N, past it the needle may only be withdrawn
  ApproachConfig approach;

  static InjectionControllerConfig read(ConfigReader& reader);
};

/// States as in CRTK's operating_state.
enum class OperatingState { kDisabled, kEnabled, kPaused, kFault };
const char* toText(OperatingState state);

/// Decides where the needle goes: takes the hand's target or its own approach, and lets through only what is safe.
///
/// Without a trusted target, force or needle pose it holds the needle where its set-point is. When the needle does not
/// follow it goes to FAULT, which only `disable` leaves. It moves the needle in no state but ENABLED; targets count
/// from where the needle was when it was enabled, resumed or held.
class InjectionController {
 public:
  /// What the controller can trust now; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> target;            ///< m, `world`
    std::optional<Eigen::Vector3d> needle;            ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;             ///< N, of the cell on the tip, `world`
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of the pipette, out of the cell, `world`
  };

  explicit InjectionController(const InjectionControllerConfig& config);

  /// enable, disable, pause, resume, home (CRTK state_command). home withdraws the needle along the pipette and takes
  /// it over where it was enabled, never deeper than it is, also without a trusted force; then pauses: the way out when
  /// the needle is held. Empty when obeyed, otherwise the reason for the refusal; the state is then as before.
  std::string command(const std::string& command);

  /// One cycle of dt (s): the set-point for the needle (m, `world`); empty while DISABLED or in FAULT.
  std::optional<Eigen::Vector3d> step(const Input& input, double dt);

  /// Never faster than this (m/s), nor than configured: for a rig that follows late.
  void limitSpeed(double speed) { rig_speed_ = speed; }

  OperatingState state() const { return state_; }
  bool busy() const;                            ///< moves of its own accord: homes or approaches
  bool homed() const { return needle_known_; }  ///< axes are absolute: homed as soon as the needle's pose is known
  const std::string& heldBecause() const { return held_because_; }  ///< empty while the needle follows
  bool followsTarget() const { return state_ == OperatingState::kEnabled && held_because_.empty(); }

 private:
  std::optional<Eigen::Vector3d> wanted(const Input& input, double dt);
  bool needleIsLost(const Eigen::Vector3d& needle);
  std::optional<Eigen::Vector3d> approachTarget(const Input& input, double dt);
  void goHome(const Eigen::Vector3d& axis, double dt);
  void follow(const Eigen::Vector3d& target, const Input& input, double dt);

  InjectionControllerConfig config_;
  OperatingState state_ = OperatingState::kDisabled;
  Approach approach_;
  std::optional<Eigen::Vector3d> setpoint_;         ///< m; taken from the needle when it is enabled
  std::optional<Eigen::Vector3d> target_offset_;    ///< m, added to targets; taken with the first one once enabled
  Eigen::Vector3d home_ = Eigen::Vector3d::Zero();  ///< m, where the needle was enabled
  double rig_speed_ = std::numeric_limits<double>::infinity();  ///< m/s
  bool homing_ = false;
  bool needle_known_ = false;
  std::string held_because_ = "DISABLED";
};

}  // namespace microinjection
