#pragma once

#include <Eigen/Core>
#include <optional>

#include "cell/material/material.h"

namespace microinjection {

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
