#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cell/pose/cell_motion.h"

namespace microinjection {

/// What benchmarks of a moving cell have in common: a cell of 40 um at a mouth of 10 um, and a needle of 3 um.
constexpr double kHeldTip = 3e-6;  ///< m, of the needle's end

inline PipetteMouth heldMouth() { return PipetteMouth(10e-6, 40e-6, 5e-6, 1); }

/// A tool at a place (m) whose own axis, out of its end into its shaft, points along `axis` in the dish's frame.
inline ToolPose along(const Eigen::Vector3d& axis, const Eigen::Vector3d& position) {
  return {position, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis)};
}

inline CellMotionConfig withoutDish() {
  CellMotionConfig config;
  config.dish_height = -1;
  return config;
}

/// A cell `gap` (m) before the mouth, whose tube points along -x from input.mouth.position, which it turns so.
/// @param pressure Pa, which the input gets
inline CellMotion placedBeforeMouth(const CellMotionConfig& config, CellMotionInput& input, double pressure,
                                    double gap = 0) {
  CellMotion motion(config, heldMouth(), RoundedTip(kHeldTip, kHeldTip));
  input.mouth.orientation = along(-Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero()).orientation;
  input.pressure = pressure;
  const Eigen::Vector3d away(heldMouth().touchDistance(config.radius) + gap, 0, 0);
  motion.place(input.mouth.position + away, Eigen::Quaterniond::Identity(), input);
  return motion;
}

}  // namespace microinjection
