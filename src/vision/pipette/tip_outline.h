#pragma once

#include "vision/pipette/pipette_strip.h"

namespace microinjection {

/// Both outer walls of a tube behind its end: two straight lines that are symmetric to its axis.
struct TipOutline {
  bool valid = false;
  double half_width = 0;  ///< columns, at the end
  double growth = 0;      ///< columns per row
};

/// Measures the outer walls in the rows just behind an end. Every row counts alike, because a thin wall is fainter at
/// the end than farther back. Of lines that are nearly as clear the outermost is the outline.
/// @param end   row
/// @param most  columns, of the half width at the end
TipOutline measureOutline(const PipetteStrip& strip, double end, double most);

}  // namespace microinjection
