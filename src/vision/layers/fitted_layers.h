#pragma once

#include "vision/frame/contrast_mode.h"
#include "vision/layers/cell_layers.h"

namespace microinjection {

/// Measures the borders of a cell with a zona by the joint fit of layer_fit.h, and sets their verdicts.
/// In bright field a zona's outer border that is found already keeps its place: its line stands alone.
/// @return true: the fit describes the outer border
bool fitLayersTo(const Frame& frame, ContrastMode mode, CellLayers& layers);

/// The same in the next frame, from borders that were followed and the zona's inner border of the frame
/// before, whose verdict stays when it is seen again.
void refitLayersTo(const Frame& frame, ContrastMode mode, const CellLayers& previous, CellLayers& layers);

/// A line keeps its size from frame to frame: where it does not, it is another line with another centre.
void requireSameLine(const CellBorder& previous, CellBorder& border);

}  // namespace microinjection
