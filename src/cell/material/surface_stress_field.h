#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cell/material/material.h"

namespace microinjection {

/// A body's outer surface with what loads it.
struct LoadedSurface {
  std::vector<Eigen::Vector3d> rest, deformed;  ///< m, of each vertex
  std::vector<std::array<int, 3>> triangles;    ///< counter-clockwise seen from outside
  std::vector<bool> touched;                    ///< vertices that another body presses
  std::vector<bool> held;                       ///< vertices on which an unknown force may act
};

/// Mean pressure on the touched part of the deformed surface, Pa: the force along that part's mean
/// normal over its area, a third of each triangle for each of its touched vertices. 0 where nothing
/// is touched, or for a force that pulls.
/// @param force  N, of the body on the one that touches it
double meanContactPressure(const LoadedSurface& surface, const Eigen::Vector3d& force);

/// Stress of the outermost layer at the vertices of its surface, Pa: the mean of their triangles,
/// weighted by area at rest. NaN where it is not known: between held vertices, and where
/// deformationBehind() has no solution.
struct SurfaceStressField {
  std::vector<double> von_mises;
  std::vector<double> pressure;
  /// F N, N being the normal at rest: the material that was at X - h N is at x - h (F N), to first
  /// order in the depth h. NaN where it is not known.
  std::vector<Eigen::Vector3d> normal_column;
};

/// @param pressure  Pa, on the touched part; 0 elsewhere
SurfaceStressField surfaceStress(const LoadedSurface& surface, const Material& material, double pressure);

}  // namespace microinjection
