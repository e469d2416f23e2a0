#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct MotionMappingConfig {
  std::string mode =
      "position";  ///< position (of the hand -> of the needle) or rate (of the hand -> speed of the needle)
  double position_scale = 1e-3;  ///< 1, metres of needle per metre of hand
  double rate_gain = 2e-3;       ///< 1/s, speed of the needle per deflection of the hand past the dead zone
  double dead_zone = 5e-3;       ///< m, deflection of the hand that moves nothing
  double rate_limit = 50e-6;     ///< m/s, the fastest that a deflection asks for

  /// Keys mode, position_scale and the section rate_mode.
  static MotionMappingConfig read(ConfigReader& reader);
};

/// Where the needle shall be, from where the hand is.
///
/// Position mode: target = needle at the start + position_scale (hand - hand at the start). Rate mode, for devices
/// without a workspace worth the name (space mouse, joystick): the deflection from the device's own zero, less the dead
/// zone, is a velocity; letting go stops. Never from anywhere else: a device let go would then drive the needle.
class MotionMapping {
 public:
  explicit MotionMapping(const MotionMappingConfig& config) : config_(config) {}

  /// The hand (m) and the needle (m) belong together from here on.
  void setReference(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle);
  /// The target (m, `world`) for the hand (m, axes as `world`), dt (s) after the one before.
  const Eigen::Vector3d& step(const Eigen::Vector3d& hand, double dt);
  /// In rate mode goes on from here (m): the target has met a limit.
  void limitTo(const Eigen::Vector3d& target) { target_ = target; }
  /// How far (m of the hand) the hand is from where it would leave the needle at `needle` (m). Rate mode: 0, the hand's
  /// place says nothing of the needle's.
  double misalignment(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) const;
  /// Whether a hand here (m) leaves the needle at rest wherever that is: position mode always, rate mode in the dead
  /// zone.
  bool release(const Eigen::Vector3d& hand) const;
  bool isRate() const { return config_.mode == "rate"; }

 private:
  MotionMappingConfig config_;
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();    ///< m, at the start; counts in position mode
  Eigen::Vector3d needle_ = Eigen::Vector3d::Zero();  ///< m, at the start
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace microinjection
