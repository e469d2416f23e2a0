#include "cell/mesh/cell_mesh_config.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cell/mesh/config_check.h"

namespace microinjection {
namespace {

/// The thinnest layer over the radius of the cell: thinner ones take millions of elements.
constexpr double kThinnestLayer = 1.0 / 100;

/// The smallest element over the radius of the cell: OpenCASCADE's tolerance is 1e-7.
constexpr double kSmallestSize = 1e-5;

/// Further stretched, the cell that gmsh meshes would be a pancake.
constexpr double kMostStretched = 4;

/// Circles end here, in radii of the cell: further out the surface is too steep.
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

/// @pre the radii are good
void checkRefinement(ConfigCheck& check, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Refinement& refinement = config.refinements[i];
  const auto key = [i](const std::string& field) { return keyOf("refinements", i, field); };
  const double cell = config.radii.front(), from_axis = refinement.centre.norm();
  const bool ball = refinement.shape == CellMeshConfig::Shape::kBall;
  check.require(from_axis < cell, key("centre"), from_axis, "nearer to the z axis than the cell's radius");
  if (ball) {
    check.require(std::isfinite(refinement.radius) && refinement.radius >= 0, key("radius"), refinement.radius,
                  "0 or positive");
  } else {
    check.require(isPositive(refinement.radius) && from_axis + refinement.radius < cell, key("radius"),
                  refinement.radius,
                  "positive, and with the centre's distance from the z axis below the cell's radius");
  }
  check.require(isSide(refinement.side), key("side"), refinement.side, "+1 or -1");
  check.require(std::isfinite(refinement.size) && refinement.size >= kSmallestSize * cell, key("size"), refinement.size,
                "at least 1e-5 of the cell's radius");
}

/// @pre the radii are good
void checkImprint(ConfigCheck& check, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Circle& circle = config.imprints[i];
  const double reach = circle.centre.norm() + circle.radius;
  check.require(isPositive(circle.radius) && circle.radius > 10 * kSmallestSize * config.radii.front() &&
                    reach < kSteep * config.radii.front(),
                keyOf("imprints", i, "radius"), circle.radius,
                "above 1e-4 and with the centre's distance from the z axis below 0.95 of the cell's radius");
  check.require(isSide(circle.side), keyOf("imprints", i, "side"), circle.side, "+1 or -1");
  for (std::size_t j = 0; j < i; ++j) {
    check.require(!touch(circle, config.imprints[j]), keyOf("imprints", i, "radius"), circle.radius,
                  "such that it keeps 0.05 of the smaller radius away from " + keyOf("imprints", j));
  }
}

}  // namespace

void CellMeshConfig::validate() const {
  ConfigCheck check("cell mesh");
  check.require(isPositive(size), "size", size, "positive");
  check.require(isPositive(growth) && growth <= 1, "growth", growth, "in (0, 1]");
  check.require(stretch >= 1 && stretch <= kMostStretched, "stretch", stretch, "from 1 to 4");
  if (check.requireLayers(radii, kThinnestLayer)) {
    check.require(!(size < kSmallestSize * radii.front()), "size", size, "at least 1e-5 of the cell's radius");
    for (std::size_t i = 0; i < refinements.size(); ++i) checkRefinement(check, *this, i);
    for (std::size_t i = 0; i < imprints.size(); ++i) checkImprint(check, *this, i);
  }
  check.finish();
}

}  // namespace microinjection
