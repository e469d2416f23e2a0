#include "cell/mesh/cell_mesh_config.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cell/mesh/layer_radii.h"

namespace microinjection {
namespace {

/// The thinnest layer over the radius of the cell. Thinner ones need millions of elements.
constexpr double kThinnestShell = 1.0 / 100;

/// The smallest element over the radius of the cell: OpenCASCADE's tolerance is 1e-7.
constexpr double kSmallestTetrahedron = 1e-5;

/// Largest stretch. Beyond it gmsh would mesh a nearly flat disc.
constexpr double kMostStretched = 4;

/// Largest distance of circles from the axis, over the cell's radius. Further out the surface is
/// too steep.
constexpr double kSteep = 0.95;

/// The narrowest gap between two circles, over the radius of the smaller one.
constexpr double kNarrowestGap = 0.05;

bool touch(const CellMeshConfig::Circle& one, const CellMeshConfig::Circle& other) {
  if (one.side != other.side) return false;
  const double apart = (one.centre - other.centre).norm();
  const double gap = std::max(apart - one.radius - other.radius, std::abs(one.radius - other.radius) - apart);
  return gap < kNarrowestGap * std::min(one.radius, other.radius);
}

bool isSide(double side) { return side == 1 || side == -1; }

/// @pre the radii are valid
void checkRefinement(ConfigErrors& errors, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Refinement& refinement = config.refinements[i];
  const auto key = [i](const std::string& field) { return keyOf("refinements", i, field); };
  const double cell = config.radii.front(), from_axis = refinement.centre.norm();
  const bool ball = refinement.shape == CellMeshConfig::Shape::kBall;
  errors.require(from_axis < cell, key("centre"), from_axis, "", "nearer to the z axis than the cell's radius");
  if (ball) {
    errors.require(std::isfinite(refinement.radius) && refinement.radius >= 0, key("radius"), refinement.radius, "",
                   "0 or positive");
  } else {
    errors.require(Range::positive().contains(refinement.radius) && from_axis + refinement.radius < cell, key("radius"),
                   refinement.radius, "",
                   "positive, and with the centre's distance from the z axis below the cell's radius");
  }
  errors.require(isSide(refinement.side), key("side"), refinement.side, "", "+1 or -1");
  errors.require(std::isfinite(refinement.size) && refinement.size >= kSmallestTetrahedron * cell, key("size"),
                 refinement.size, "", "at least 1e-5 of the cell's radius");
}

/// @pre the radii are valid
void checkImprint(ConfigErrors& errors, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Circle& circle = config.imprints[i];
  const double reach = circle.centre.norm() + circle.radius;
  errors.require(Range::positive().contains(circle.radius) &&
                     circle.radius > 10 * kSmallestTetrahedron * config.radii.front() &&
                     reach < kSteep * config.radii.front(),
                 keyOf("imprints", i, "radius"), circle.radius, "",
                 "above 1e-4 and with the centre's distance from the z axis below 0.95 of the cell's radius");
  errors.require(isSide(circle.side), keyOf("imprints", i, "side"), circle.side, "", "+1 or -1");
  for (std::size_t j = 0; j < i; ++j) {
    errors.require(!touch(circle, config.imprints[j]), keyOf("imprints", i, "radius"), circle.radius, "",
                   "such that it keeps 0.05 of the smaller radius away from " + keyOf("imprints", j));
  }
}

}  // namespace

void CellMeshConfig::validate() const {
  ConfigErrors errors("cell mesh");
  errors.require(Range::positive(), "size", size);
  errors.require(Range{0, 1, true, false}, "growth", growth);
  errors.require(Range::closed(1, kMostStretched), "stretch", stretch);
  if (requireLayerRadii(radii, kThinnestShell, errors)) {
    errors.require(!(size < kSmallestTetrahedron * radii.front()), "size", size, "",
                   "at least 1e-5 of the cell's radius");
    for (std::size_t i = 0; i < refinements.size(); ++i) checkRefinement(errors, *this, i);
    for (std::size_t i = 0; i < imprints.size(); ++i) checkImprint(errors, *this, i);
  }
  errors.throwAny();
}

}  // namespace microinjection
