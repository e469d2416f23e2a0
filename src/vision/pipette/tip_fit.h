#pragma once

#include "vision/pipette/pipette_strip.h"
#include "vision/pipette/tip_outline.h"

namespace microinjection {

/// Where a tube ends, by a fit to the grey values around its end.
struct TipFit {
  bool valid = false;
  double row = 0;
  double deviation = 0;    ///< rows, standard deviation
  double misfit = 0;       ///< variance of the residuals over that of the noise and the model
  bool ambiguous = false;  ///< in focus and out of focus explain the image as well, with other ends
};

/// Whether noise of this standard deviation is so small that a compression has taken it away. It leaves errors of its
/// own at the edges.
bool isCompressed(double noise);

/// Finds the end of a tube by the model of tip_model.h, in focus or out of focus, whichever leaves
/// less. The deviation is that of the end's likelihood. It grows when a point fades into its
/// background.
/// @param outline  of the walls behind the end
/// @param coarse  row where the tube ends, to a few rows
/// @param noise   standard deviation of a pixel
TipFit fitTip(const PipetteStrip& strip, const TipOutline& outline, double coarse, double noise);

}  // namespace microinjection
