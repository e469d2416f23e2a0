#pragma once

#include <Eigen/Core>
#include <functional>

namespace microinjection {

/// Speeds of a move of a device that is told a speed for each axis, and rounds it.
struct AxisSpeeds {
  Eigen::Vector3d speeds = Eigen::Vector3d::Zero();  ///< of the axes; 0: the axis rests
  double duration = 0;                               ///< s, until the last axis arrives
  double deviation = 0;                              ///< largest distance from the straight line
};

/// The fastest speeds, at most `speed` along the path and not much slower, that stay within
/// `good_enough` of the line, or else those closest to it. If there are none, an axis would have to
/// be slower than the device can go, and the move is faster than wanted. `most`: largest speed of
/// each axis; `nearest`: the speed above 0 that the device can be told next to one. All in one unit
/// of length.
AxisSpeeds straightSpeeds(const Eigen::Vector3d& displacement, double speed, const Eigen::Vector3d& most,
                          double good_enough, const std::function<double(double)>& nearest);

}  // namespace microinjection
