#pragma once

#include <string>

#include "vision/detection/cell_layers.h"

namespace microinjection {

/// Measures the borders of a cell with a zona by the joint fit of layer_fit.h, and sets their verdicts.
/// In bright field a zona's outer border that is found already keeps its place: its line stands alone.
/// @return true: the fit describes the outer border
bool fitLayersTo(const Frame& frame, const std::string& look, CellLayers& layers);

}  // namespace microinjection
