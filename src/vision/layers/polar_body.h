#pragma once

#include "vision/frame/contrast_mode.h"
#include "vision/layers/cell_layers.h"

namespace microinjection {

/// The polar body between ooplasm and zona.
struct PolarBody {
  Finding finding;
  double angle = 0;      ///< rad in (-pi, pi], from the centre of the zona's outer border, from x towards y (down)
  double deviation = 0;  ///< rad, standard deviation
  Ellipse outline;       ///< px, a circle
};

/// Searches a small circle inside of the zona whose border darkens outwards; in DIC its border is
/// shaded and either change counts. Needs a zona. One that lies above or below the ooplasm is not seen.
PolarBody findPolarBody(const Frame& frame, const CellLayers& layers, ContrastMode mode);

/// The same near the direction in which it was seen in the frame before.
PolarBody followPolarBody(const Frame& frame, const CellLayers& layers, ContrastMode mode, const PolarBody& previous);

}  // namespace microinjection
