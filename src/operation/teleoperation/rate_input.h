#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "base/config_reader.h"
#include "base/repetition.h"

namespace microinjection {

/// Meaning of a joystick's axes and buttons. Numbers count from 0 as in sensor_msgs/Joy.
struct RateInputConfig {
  Eigen::Vector3d axes = {0, 1, 2};                    ///< axes of the joystick along the hand's x, y, z
  Eigen::Vector3d deflection = {0.015, 0.015, 0.015};  ///< m of the hand at an axis value of 1; negative: reversed
  double centre = 0.1;                                 ///< 1, axis values below it count as released
  int dead_man = -1;                                   ///< dead-man button; -1: none
  double renewal = 1.5;  ///< s at full deflection, longer at a smaller one, for which an unchanged deflection counts

  static RateInputConfig read(ConfigReader& reader);
};

/// A hand whose position is a joystick's deflection, for rate mode: 0 when the stick is released.
///
/// It has no clutch: releasing the stick stops the needle. The operator is present while the
/// dead-man button is held and the stick was released once since then: pressing the button does not
/// start a deflected stick's motion.
///
/// A hand never holds a stick quite still, but a receiver that has lost its gamepad repeats the last state, with the
/// dead-man button held. An unchanged deflection therefore counts only for a while, which bounds the needle's way. A
/// device that rests off its zero repeats that deflection, too: it becomes the zero.
class RateInput {
 public:
  explicit RateInput(const RateInputConfig& config);

  struct Reading {
    Eigen::Vector3d position;  ///< m
    bool operator_present = false;
  };
  /// `time`: s, never set back. Returns empty when the joystick lacks a configured axis or button, or an axis is not
  /// within -1.5..1.5, or while repeats().
  std::optional<Reading> read(const std::vector<float>& axes, const std::vector<int>& buttons, double time);
  /// The joystick is stale: the stick must be released again.
  void reset() { released_ = false; }
  /// Whether the deflection has not changed for longer than RateInputConfig::renewal allows.
  bool repeats() const { return deflection_.repeats(); }

 private:
  RateInputConfig config_;
  bool released_ = false;                           ///< the stick was released since the dead-man button is held
  Eigen::Vector3d zero_ = Eigen::Vector3d::Zero();  ///< shares of the axes, of a device that rests there
  Repetition<Eigen::Vector3d> deflection_;          ///< shares, exposed to s x deflection
  Repetition<Eigen::Vector3d> rest_;                ///< the same, exposed to s
  double time_ = 0;                                 ///< s, of the last reading
};

}  // namespace microinjection
