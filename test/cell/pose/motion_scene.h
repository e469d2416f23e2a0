#pragma once

#include "cell/pose/cell_motion.h"

namespace microinjection {

// A mouse oocyte at the lip of a holding pipette that lies along x, its tube towards -x; metres.
constexpr double kBoreRadius = 10e-6, kTubeRadius = 40e-6, kLipEdgeRadius = 5e-6;

inline PipetteMouth holdingMouth(double bore = kBoreRadius) {
  return PipetteMouth(bore, bore + kTubeRadius - kBoreRadius, kLipEdgeRadius, 1);
}

/// A pipette whose own z points along `axis`.
inline ToolPose toolAlong(const Eigen::Vector3d& axis, const Eigen::Vector3d& position) {
  return {position, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis)};
}

inline ToolPose mouthAt(const Eigen::Vector3d& position) { return toolAlong(-Eigen::Vector3d::UnitX(), position); }

inline const CellMotionState& stepsOf(CellMotion& motion, const CellMotionInput& input, int count,
                                      double duration = 1e-3) {
  for (int i = 0; i < count; ++i) motion.step(duration, input);
  return motion.state();
}

/// Places the cell coaxially in front of the mouth, its surface `gap` (m) from the lip.
inline void placeBefore(CellMotion& motion, const CellMotionInput& input, double gap = 0) {
  const double distance = holdingMouth().touchDistance(motion.config().radius) + gap;
  motion.place(input.mouth.position + Eigen::Vector3d(distance, 0, 0), Eigen::Quaterniond::Identity(), input);
}

}  // namespace microinjection
