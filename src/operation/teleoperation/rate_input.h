#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/config_reader.h"

namespace microinjection {

/// Which of a joystick's axes and buttons mean what. Numbers count from 0 as in sensor_msgs/Joy.
struct RateInputConfig {
  Eigen::Vector3d axes = {0, 1, 2};                    ///< axes of the joystick along the hand's x, y, z
  Eigen::Vector3d deflection = {0.015, 0.015, 0.015};  ///< m of the hand at an axis' 1; negative: the other way round
  double centre = 0.1;                                 ///< 1, share of an axis within which it counts as let go
  int dead_man = -1;                                   ///< button to be held down; -1: none

  static RateInputConfig read(ConfigReader& reader);
};

/// A hand whose place is a joystick's deflection, for rate mode: let go, it is at 0.
///
/// It has no clutch: letting go stops the needle. The operator is present while the dead-man's button is held, from
/// when the stick was let go first: the dead-man's button does not set a deflected stick off.
class RateInput {
 public:
  explicit RateInput(const RateInputConfig& config) : config_(config) {}

  struct Reading {
    Eigen::Vector3d position;  ///< m
    bool operator_present = false;
  };
  /// Empty when the joystick has not the axes and the button that were asked for, or an axis is not within -1.5..1.5.
  std::optional<Reading> read(const std::vector<float>& axes, const std::vector<int>& buttons);
  /// The joystick is silent.
  void lose() { released_ = false; }

 private:
  RateInputConfig config_;
  bool released_ = false;  ///< was let go since the dead-man's button is held
};

}  // namespace microinjection
