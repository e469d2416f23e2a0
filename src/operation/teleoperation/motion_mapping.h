#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

struct MotionMappingConfig {
  std::string mode = "position";  ///< position (hand's position sets the needle's) or rate (hand's position sets the
                                  ///< needle's velocity)
  double position_scale = 1e-3;   ///< 1, metres of needle per metre of hand
  double rate_gain = 2e-3;        ///< 1/s, speed of the needle per deflection of the hand past the dead zone
  double dead_zone = 5e-3;        ///< m, deflection of the hand without effect
  double rate_limit = 50e-6;      ///< m/s, largest commanded speed

  /// Keys mode, position_scale and the section rate_mode.
  static MotionMappingConfig read(ConfigReader& reader);
};

/// Computes the target of the needle from the position of the hand.
///
/// Position mode: target = needle at the start + position_scale (hand - hand at the start). Rate
/// mode, for devices with a small workspace (space mouse, joystick): the deflection, less the dead
/// zone, sets a velocity. Deflections always count from the device's own zero, so a released device
/// stops the needle.
class MotionMapping {
 public:
  explicit MotionMapping(const MotionMappingConfig& config) : config_(config) {}

  /// Sets the reference: this position of the hand (m) belongs to this position of the needle (m).
  void setReference(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle);
  /// Returns the target (m, `world`) for the hand (m, axes as `world`), dt (s) after the last one.
  const Eigen::Vector3d& step(const Eigen::Vector3d& hand, double dt);
  /// Moves the target to a limit (m). Rate mode continues from there.
  void limitTo(const Eigen::Vector3d& target) { target_ = target; }
  /// Distance (m) of the hand from the position that belongs to `needle` (m). In rate mode 0: no
  /// position of the hand belongs to one of the needle.
  double misalignment(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) const;
  /// Whether a hand here (m) commands no motion at engagement: always in position mode, in the dead
  /// zone in rate mode.
  bool isAtRest(const Eigen::Vector3d& hand) const;
  bool isRate() const { return config_.mode == "rate"; }

 private:
  MotionMappingConfig config_;
  Eigen::Vector3d hand_ = Eigen::Vector3d::Zero();    ///< m, at the start; only for position mode
  Eigen::Vector3d needle_ = Eigen::Vector3d::Zero();  ///< m, at the start
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();  ///< m
};

}  // namespace microinjection
