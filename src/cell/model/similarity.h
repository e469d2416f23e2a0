#pragma once

#include "cell/model/scene.h"

namespace microinjection {

/// Units in which a cell's mechanics have no dimension: the cell's radius R and the Young's modulus
/// E of its outermost layer. The force of an elastic cell on the tip is
///
///     F = E R^2 f(u / R; ratios of lengths, ratios of moduli, tension / (E R), Poisson's ratios),
///
/// because the equilibrium has no other length and no other stress. So one solution serves every cell of the same
/// ratios: surrogate data are stored in these units, and a family needs to vary ratios only, not sizes and moduli. The
/// radius of the outermost layer and its modulus are the units because every scene has them.
struct Similarity {
  double length = 1;   ///< m
  double modulus = 1;  ///< Pa

  static Similarity of(const Scene& scene);

  double force() const { return modulus * length * length; }            ///< N
  double energy() const { return modulus * length * length * length; }  ///< J
};

/// The scene in its own units: of radius 1 and modulus 1. Every ratio is rounded to 12 digits, so
/// that scaled scenes become the same to the last bit. Puncture, biomembrane and a tensegrity's
/// parameters keep their SI units: they do not belong to the elastic equilibrium. So do viscosity and relaxation times;
/// a caller that compares scenes takes SurrogatePlan::elastic() first.
Scene withoutDimension(const Scene& scene);

/// `value` to 12 significant digits.
double rounded(double value);

}  // namespace microinjection
