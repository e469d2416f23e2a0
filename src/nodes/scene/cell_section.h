#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <string>
#include <vector>

#include "nodes/scene/cell_stress.h"
#include "operation/display/layer_border.h"
#include "operation/display/section_cut.h"

namespace microinjection {

/// The borders between the layers: those of the model, else the second layer's to first order in the outermost
/// layer's thickness, and deeper ones as they are at rest.
std::vector<LayerBorder> bordersOf(const CellSurface& surface, const std::vector<LayerBorder>& solved,
                                   const std::optional<DisplayedSolid>& solid,
                                   const std::optional<DisplayedStress>& stress);

/// The cut face of the cell: its layers, each in its colour, and their borders; dashed where they are estimated.
/// @param plane  m
void drawSection(const std::string& frame, const CellSurface& surface, const std::vector<LayerBorder>& borders,
                 const CutPlane& plane, double enlargement, visualization_msgs::MarkerArray& markers);
/// Removes it.
void removeSection(const std::string& frame, visualization_msgs::MarkerArray& markers);

}  // namespace microinjection
