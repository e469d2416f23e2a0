#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct HapticBridgeConfig {
  double position_scale = 1e-3;  ///< 1, metres of needle per metre of hand
  double force_gain = 2e5;       ///< 1, newtons at the hand per newton at the tip
  double force_limit = 3.0;      ///< N, the largest that the haptic device is asked for
  double ramp_time = 0.1;        ///< s, over which force comes back after the loop was open

  static HapticBridgeConfig read(ConfigReader& reader);
};

/// Bilateral coupling of a haptic device and a needle: position forward, force back.
///
/// Follower = initial + scale * (leader - leader_initial). While the clutch is pressed the leader floats and the
/// follower holds; the initials are taken again on release, and whenever the loop was open for want of a trusted input.
class HapticBridge {
 public:
  /// What the bridge can trust now; empty: absent, stale or not finite.
  struct Input {
    std::optional<Eigen::Vector3d> hand;    ///< m, haptic device, axes as `world`
    std::optional<Eigen::Vector3d> needle;  ///< m, tip in `world`
    std::optional<Eigen::Vector3d> force;   ///< N, of the cell on the tip, `world`
    bool clutch = false;                    ///< pressed
  };
  struct Output {
    std::optional<Eigen::Vector3d> needle;                 ///< m, where the tip shall go; empty: hold
    Eigen::Vector3d hand_force = Eigen::Vector3d::Zero();  ///< N, at the hand
    std::string held_because;                              ///< empty while the loop is closed
  };

  explicit HapticBridge(const HapticBridgeConfig& config) : config_(config) {}

  /// One cycle of dt (s).
  Output step(const Input& input, double dt);

 private:
  Eigen::Vector3d render(const Eigen::Vector3d& tip_force, double dt);

  HapticBridgeConfig config_;
  bool engaged_ = false;
  double ramp_ = 0;                                           ///< 0..1, share of the force that is rendered
  Eigen::Vector3d hand_initial_ = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d needle_initial_ = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace microinjection
