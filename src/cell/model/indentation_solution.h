#pragma once

#include <Eigen/Core>
#include <string>

namespace microinjection {

/// Equilibrium of the cell under a needle tip.
struct IndentationSolution {
  bool converged = false;
  std::string reason;                                          ///< user-readable; empty when converged
  Eigen::Vector3d tip_displacement = Eigen::Vector3d::Zero();  ///< m, reached; the requested one when converged
  Eigen::Vector3d force = Eigen::Vector3d::Zero();             ///< N, of the cell on the needle, at tip_displacement
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, d(force)/d(tip_displacement) = -stiffness; symmetric
  double smallest_jacobian = 1;                         ///< det F of the most compressed element
  int newton_iterations = 0;
  double cpu_time = 0;  ///< s, of the calling thread
};

}  // namespace microinjection
