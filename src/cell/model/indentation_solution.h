#pragma once

#include <Eigen/Core>
#include <string>

namespace microinjection {

/// The cell at rest under a needle tip.
struct IndentationSolution {
  bool converged = false;
  std::string reason;                                          ///< why not, for people; empty when converged
  Eigen::Vector3d tip_displacement = Eigen::Vector3d::Zero();  ///< m, reached: the one asked for when converged
  Eigen::Vector3d force = Eigen::Vector3d::Zero();             ///< N, of the cell on the needle, at tip_displacement
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, d(force)/d(tip_displacement) = -stiffness; symmetric
  double smallest_jacobian = 1;                         ///< det F of the element that is compressed most
  int newton_iterations = 0;
  double cpu_time = 0;  ///< s, of the calling thread
};

}  // namespace microinjection
