#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
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

/// A flat piece of a body's surface: two of its edges, m, at rest and deformed, counter-clockwise
/// seen from outside.
struct SurfacePiece {
  using Edges = Eigen::Matrix<double, 3, 2>;
  Edges rest;
  Edges deformed;
};

/// Deformation gradient F of the material behind a piece of the surface. The edges give F in the
/// surface. Its third column f = F N, N being the normal at rest, is that for which the stress
/// carries the load on the surface,
///
///     P(F) N = -pressure cof(F) N,
///
/// a pressure on the deformed surface without friction; for a linear material it is -pressure N. The
/// right side depends on the edges only. f minimises W(F) + pressure cof(F) N . f, by Newton's method
/// with a line search.
/// @param pressure  Pa; 0 on a free surface
/// @returns nothing for a degenerate piece, or when there is no such f
std::optional<Eigen::Matrix3d> deformationBehind(const SurfacePiece& piece, const Material& material, double pressure);

/// Cauchy stress, Pa, without the viscous part; a linear material's stress is its own.
Eigen::Matrix3d cauchyStress(const Material& material, const Eigen::Matrix3d& F);
/// Von Mises' equivalent stress, Pa.
double vonMisesStress(const Eigen::Matrix3d& cauchy);
/// Pa, a third of the negative trace: positive in compression.
double pressureOf(const Eigen::Matrix3d& cauchy);

}  // namespace microinjection
