#pragma once

#include <cell_microinjection/CellState.h>

#include <optional>
#include <string>
#include <vector>

#include "operation/display/cell_surface.h"
#include "operation/display/layer_border.h"

namespace microinjection {

/// The deformed surface of a message, in its frame; see CellSurface::defect().
CellSurface toSurface(const cell_microinjection::CellState& message);

/// The borders between layers that the message has and that can be drawn.
std::vector<LayerBorder> toBorders(const cell_microinjection::CellState& message);

/// Value (SI) of a parameter of the felt cell; empty when the message has no such name, or its value
/// is not finite.
std::optional<double> cellParameter(const cell_microinjection::CellState& message, const std::string& name);

}  // namespace microinjection
