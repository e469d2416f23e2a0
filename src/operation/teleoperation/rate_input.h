#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// Meaning of a joystick's axes and buttons. Numbers count from 0 as in sensor_msgs/Joy.
struct RateInputConfig {
  Eigen::Vector3d axes = {0, 1, 2};                    ///< axes of the joystick along the hand's x, y, z
  Eigen::Vector3d deflection = {0.015, 0.015, 0.015};  ///< m of the hand at an axis value of 1; negative: reversed
  double centre = 0.1;                                 ///< 1, axis values below it count as released
  int dead_man = -1;                                   ///< dead-man button; -1: none

  static RateInputConfig read(ConfigReader& reader);
};

/// A hand whose position is a joystick's deflection, for rate mode: 0 when the stick is released.
///
/// It has no clutch: releasing the stick stops the needle. The operator is present while the
/// dead-man button is held and the stick was released once since then: pressing the button does not
/// start a deflected stick's motion.
class RateInput {
 public:
  explicit RateInput(const RateInputConfig& config) : config_(config) {}

  struct Reading {
    Eigen::Vector3d position;  ///< m
    bool operator_present = false;
  };
  /// Returns empty when the joystick lacks a configured axis or button, or an axis is not within
  /// -1.5..1.5.
  std::optional<Reading> read(const std::vector<float>& axes, const std::vector<int>& buttons);
  /// The joystick is stale: the stick must be released again.
  void reset() { released_ = false; }

 private:
  RateInputConfig config_;
  bool released_ = false;  ///< the stick was released since the dead-man button is held
};

}  // namespace microinjection
