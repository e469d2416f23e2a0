#pragma once

#include <cell_microinjection/CellState.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/material/material.h"
#include "cell/material/surface_stress.h"
#include "operation/display/cell_surface.h"
#include "operation/display/surface_quantity.h"

namespace microinjection {

/// The solid whose surface is displayed.
struct DisplayedSolid {
  MaterialConfig material;                           ///< of the outermost layer, long-term
  double surface_tension = 0;                        ///< N/m, of its outer surface
  std::vector<double> layer_radii;                   ///< m, at rest, outermost first
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, at rest
};

/// Nothing for a cell that is no solid, or a message without a valid law.
std::optional<DisplayedSolid> toSolid(const cell_microinjection::CellState& message);

/// Stress of the outermost layer at the surface, and the mean pressure of the contact; elastic, long-term.
struct DisplayedStress {
  SurfaceStressField field;
  std::vector<double> contact_pressure;  ///< Pa, at each vertex; 0 off the contact
};

/// @param force   N, of the cell on the tip, in the surface's frame; nothing: the stress under the tip is not known
/// @param reason  why there is none
std::optional<DisplayedStress> stressOf(const CellSurface& surface, const std::optional<DisplayedSolid>& solid,
                                        const std::optional<Eigen::Vector3d>& force, std::string& reason);

/// Values of a quantity at the vertices. Without a stress, they are the displacement's, and `quantity` becomes that.
std::vector<double> valuesOf(const CellSurface& surface, const std::optional<DisplayedStress>& stress,
                             SurfaceQuantity& quantity);

/// Those that the colour scale shows in full. A stress under the tip is not among them: it is a rough one, and several
/// times larger than that of the rest.
std::vector<double> valuesForScale(const CellSurface& surface, SurfaceQuantity quantity, std::vector<double> values);

}  // namespace microinjection
