#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "cell/model/cell_problem.h"
#include "cell/model/scene.h"

namespace microinjection {

/// A cell held by one pressure.
struct TonguePoint {
  bool converged = false;
  std::string reason;  ///< why it did not converge, or why no finer mesh has a solution; else empty
  HeldCell held;       ///< on the finest mesh that has a solution; its pressure is that asked for
  /// Relative, of the tongue's length, from the last two meshes and the contact's stiffness.
  double error_estimate = std::numeric_limits<double>::quiet_NaN();
  double level = -1;  ///< of that mesh, see scene_mesh.h
};

struct ConvergedTongueConfig {
  double tolerance = 0.005;  ///< relative error of the tongue's length below which no finer mesh is tried
  double finest = 3;         ///< last level of refinement that may be tried, see scene_mesh.h
};

/// The tongue that suction draws into the mouth of the scene's holding pipette, at each pressure (Pa, gauge, in any
/// order), solved in the cell's section on finer and finer meshes until two of them agree. The elements at the lip
/// halve from mesh to mesh, and the error is at most of first order in them, so that the last change bounds it (as in
/// ConvergedForce). A pressure has no solution where the cell has no equilibrium: it is drawn in without end.
/// @param report called after each mesh with its level and the number of pressures that it has solved
/// @returns points in the order of the pressures; a point is converged when at least two meshes have it
/// @throws ConfigError when the holding pipette has no mouth, a pressure is above 0 or not finite, or the scene is a
///         tensegrity
std::vector<TonguePoint> convergedTongues(const Scene& scene, const std::vector<double>& pressures,
                                          const ConvergedTongueConfig& config = {},
                                          const std::function<void(double, std::size_t)>& report = {});

/// Tongue lengths over the cell's radius, of rising suction over modulus, on one mesh: the shape of a scene's curve,
/// which the modulus only stretches along the pressure (Similarity). Ends where there is no equilibrium any more.
/// @param suctions over the outermost layer's modulus, ascending, >= 0
/// @returns as many lengths as there are equilibria, from the first on
std::vector<double> tongueCurve(const Scene& scene, const std::vector<double>& suctions, double level);

}  // namespace microinjection
