#pragma once

#include "vision/pipette/pipette_strip.h"

namespace microinjection {

/// Both outer walls of a pipette in a strip about its axis: two lines that are symmetric to it.
struct PipetteOutline {
  bool valid = false;
  double half_width = 0;  ///< columns, at row 0 of the strip
  double growth = 0;      ///< columns per row
  double symmetry = 0;    ///< 0..1, of the edges within and beside the outline; low for an axis of one wall
  int last = 0;           ///< first row of the strip, seen from the shaft, that still has both walls
  double at(double row) const { return half_width + growth * row; }
};

/// Finds the widest pair of symmetric lines whose edges are followed without a gap from the frame's
/// border inwards.
/// @param narrowest  columns, of the half width at the frame's border
PipetteOutline findOutline(const PipetteStrip& strip, double narrowest);

}  // namespace microinjection
