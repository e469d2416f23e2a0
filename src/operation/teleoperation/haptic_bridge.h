#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "operation/teleoperation/engagement.h"
#include "operation/teleoperation/force_limiter.h"
#include "operation/teleoperation/force_source.h"
#include "operation/teleoperation/frame_mapping.h"
#include "operation/teleoperation/motion_mapping.h"
#include "operation/teleoperation/passivity_controller.h"
#include "operation/teleoperation/tremor_filter.h"
#include "operation/teleoperation/virtual_coupling.h"
#include "operation/teleoperation/virtual_fixtures.h"

namespace microinjection {

struct HapticBridgeConfig {
  double force_gain = 2e5;        ///< 1, newtons at the hand per newton at the tip
  double ramp_time = 0.1;         ///< s, time in which the force rises after engagement
  bool require_operator = false;  ///< hold unless the device reports the operator as present
  FrameMappingConfig frame;
  MotionMappingConfig motion;
  EngagementConfig engagement;
  TremorFilterConfig tremor;
  VirtualFixturesConfig fixtures;
  ForceSourceConfig force;
  ForceLimits limits;
  VirtualCouplingConfig coupling;
  PassivityConfig passivity;

  static HapticBridgeConfig read(ConfigReader& reader);
  /// The configuration in front of a LinkLeader. Proxy and contact damping then are at the rig, where they do not
  /// wait for the network: at the bridge, the proxy and the leader's damping drove each other without bound.
  HapticBridgeConfig beforeLink() const;
};

/// Bilateral coupling of a haptic device and a needle: position forward, force back.
///
///     hand --> frame --> tremor filter --> + --> motion mapping --> fixtures --> target of the needle
///                                          ^ proxy                    |
///                                  virtual coupling                   | push
///                                          ^                          v
///     hand <-- frame <-- limits <-- passivity, ramp, damping <------- + <-- gain <-- force source <-- tip forces
///
/// Engagement decides when the needle follows. The order of the two chains follows from what has to hold:
///
/// - The frame is the outermost link, so that everything within is in `world`.
/// - A force that comes late gives the hand energy that the cell never had. Position is scaled down and force up, by
///   a factor of 2e8 together with the defaults, which makes of a tiny energy at the tip a dangerous one at the hand.
///   Passivity is therefore observed at the hand's scale, behind the gain, and with the force after all limits, which
///   is the one that the device holds.
/// - The proxy yields to the force before the needle moves, so that no contact is stiffer than the device can render.
///   A smaller gain would bound the stiffness, too, but weaken a soft cell as much as glass; the proxy takes 3 % of
///   the force of a cell of 60 N/m (VirtualCoupling).
/// - The limiter is the last link, because a jump of any part before it must not kick the hand: a puncture, or a
///   change of the force's model.
///
/// doc/design/stability.md explains each link and has what was tried and given up.
///
/// While the clutch is pressed, the hand moves freely and the needle holds. Its release sets a new reference of hand
/// and needle. So does each hold for an invalid input in mode `index` (EngagementConfig). In a hold, and in position
/// mode when the followed hand is too fast to be holding the device, the force falls to zero: at the limiter's rate
/// while the hand's position is valid, so that it does not drop, otherwise at once.
class HapticBridge {
 public:
  /// Valid inputs of this cycle; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> hand;    ///< m, haptic device, its axes
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    TipForces force;                        ///< N, of the cell on the tip, in `world`
    bool hand_leaps = false;                ///< since the last step, see EngagementConfig::longestStep
    bool clutch = false;                    ///< pressed
    bool operator_present = false;          ///< counts with require_operator
    std::string no_force_reason;            ///< why the device does not render the force; empty: it does
    std::string no_motion_reason;           ///< why the needle must not follow, whoever else agrees; empty: it may
  };
  struct Output {
    std::optional<Eigen::Vector3d> needle;                 ///< m, target of the tip in `world`; empty: hold
    Eigen::Vector3d hand_force = Eigen::Vector3d::Zero();  ///< N, on the hand, the device's axes
    Engagement::State state = Engagement::State::kHeld;
    std::string hold_reason;  ///< empty while the loop is closed
  };

  /// @throws ConfigError when the axes are not a rotation or a fixture has no direction.
  explicit HapticBridge(const HapticBridgeConfig& config);

  /// One cycle of dt (s, > 0), also while inputs are invalid: the observer counts the time.
  Output step(const Input& input, double dt);

  double delay() const { return tremor_.delay(); }  ///< s, of slow motion between hand and needle
  /// J, taken from the hand; not below -passivity.reserve.
  double observedEnergy() const { return passivity_.energy(); }
  bool passivityActing() const { return passivity_.acting(); }  ///< the passivity controller changed the last force

 private:
  std::string holdReason(const Input& input, const std::optional<Eigen::Vector3d>& force) const;
  void begin(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle, const Eigen::Vector3d& force);
  /// Limits the force `wanted` (N, `world`, at the hand); returns it in the device's axes.
  Eigen::Vector3d render(const Eigen::Vector3d& wanted, double dt);

  HapticBridgeConfig config_;
  FrameMapping frame_;
  TremorFilter tremor_;
  MotionMapping motion_;
  Engagement engagement_;
  VirtualFixtures fixtures_;
  VirtualCoupling coupling_;
  PassivityController passivity_;
  ForceLimiter limiter_;
  double ramp_ = 0;                                               ///< 0..1, share of the force that is rendered
  Eigen::Vector3d proxy_offset_start_ = Eigen::Vector3d::Zero();  ///< m, of the coupling at engagement
};

}  // namespace microinjection
