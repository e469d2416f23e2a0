#pragma once

#include <string>
#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// A number without dimension that determines a cell's force (see similarity.h).
struct Ratio {
  const char* name;
  bool logarithmic;  ///< its logarithm is the coordinate of an interpolation
  int layers;        ///< that a cell has at least
  double (*get)(const Scene& scene);
  void (*set)(Scene& scene, double value);
};

/// tip_radius, holding_radius, shell_thickness: over the cell's radius; core_modulus: of the second
/// layer over that of the shell; surface_tension: over modulus and radius; poisson_ratio: of all
/// layers. `get` and `set` take a scene without dimension; `set` rounds as withoutDimension does.
const std::vector<Ratio>& ratios();

/// Ratios that determine a cell in the mouth of a pipette. bore_radius: over the cell's radius; lip_edge:
/// radius of the lip's edge over that of the bore; wall: thickness over twice the edge's radius, 1 for a lip that is
/// round all over; suction_root: the root of the suction over the modulus; then those of ratios() but holding_radius
/// and surface_tension. `set` must be called in this order. @pre the scenes have a mouth
const std::vector<Ratio>& mouthRatios();

/// Ratios that determine a cell under a needle that rubs, adheres or pierces it: those of ratios() for one layer, then
/// friction (Coulomb's coefficient), toughness (of the outermost layer, over shear modulus and tip's radius),
/// adhesion_root (the root of the energy over modulus and tip's radius) and adhesion_range (over the tip's radius).
/// `set` must be called in this order.
const std::vector<Ratio>& needleRatios();

}  // namespace microinjection
