#pragma once

#include <string>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {

/// The mouth of a holding pipette in a strip about its axis.
struct HoldingMouth {
  bool valid = false;
  double row = 0;         ///< of the outermost place of both lips
  double deviation = 0;   ///< rows, standard deviation
  double slant = 0;       ///< rows per column, of the line over both lips
  double score = 0;       ///< 0..1, edge along both lips relative to that of the walls
  double half_width = 0;  ///< columns, of the walls
  std::string doubt;      ///< empty, or why the mouth is not certain
  bool faint = false;     ///< it is not certain, since its lips are not clear
};

/// Fits a round lip to the end of each wall: an arc that is tangent to the outer edge of the wall and
/// has its sign. A border of a cell that the pipette holds is not tangent to both walls.
/// @param coarse      row where the outer walls end, roughly
/// @param reach       rows that the mouth may be off
/// @param half_width  columns, of the outer walls near the mouth
HoldingMouth findMouth(const PipetteStrip& strip, double coarse, double reach, double half_width);

}  // namespace microinjection
