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
  double ramp_time = 0.1;         ///< s, over which force comes back after the loop was open
  bool require_operator = false;  ///< hold unless the device says that the operator is there
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
  /// The same in front of a LinkLeader: the proxy is at the rig, where it does not wait for the network, and so is the
  /// damping of what answers late.
  HapticBridgeConfig beforeLink() const;
};

/// Bilateral coupling of a haptic device and a needle: position forward, force back.
///
///     hand -> frame -> tremor filter -> coupling -> motion mapping -> fixtures -> needle's target
///     hand <- frame <- passivity, limits <- gain, ramp <- force source <- tip forces
///
/// While the clutch is pressed the leader floats and the follower holds; hand and needle belong together anew on
/// release, and (see EngagementConfig) whenever the loop was open for want of a valid input. In a hold the force
/// falls to zero, as it does when the hand that is followed gets too fast to be one that holds the device (position
/// mode): by the limiter's rate while the hand is known, so that it is not dropped, at once where it is not.
class HapticBridge {
 public:
  /// What the bridge can trust now; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> hand;    ///< m, haptic device, its axes
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    TipForces force;                        ///< N, of the cell on the tip, `world`
    bool clutch = false;                    ///< pressed
    bool operator_present = false;          ///< counts with require_operator
    std::string unfelt;                     ///< why the device does not take the force on the hand; empty: it does
  };
  struct Output {
    std::optional<Eigen::Vector3d> needle;                 ///< m, where the tip shall go; empty: hold
    Eigen::Vector3d hand_force = Eigen::Vector3d::Zero();  ///< N, on the hand, the device's axes
    Engagement::State state = Engagement::State::kHeld;
    std::string hold_reason;  ///< empty while the loop is closed
  };

  /// @throws ConfigError on axes that are no rotation or fixtures without direction.
  explicit HapticBridge(const HapticBridgeConfig& config);

  /// One cycle of dt (s).
  Output step(const Input& input, double dt);

  double delay() const { return tremor_.delay(); }  ///< s, added to slow motion on the way to the needle
  double observedEnergy() const {
    return passivity_.energy();
  }  ///< J, taken from the hand; not below -passivity.reserve
  bool passivityActing() const { return passivity_.acting(); }  ///< the controller changed the last force

 private:
  std::string holdReason(const Input& input, const std::optional<Eigen::Vector3d>& force) const;
  void begin(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle, const Eigen::Vector3d& force);
  /// Force (N, `world`, at the hand) for the next period.
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
  Eigen::Vector3d proxy_offset_start_ = Eigen::Vector3d::Zero();  ///< m, of the coupling at the start
};

}  // namespace microinjection
