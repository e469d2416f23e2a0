#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {

/// Row at which a pipette ends, in a strip whose rows go towards its shaft.
struct PipetteEnd {
  bool valid = false;
  double row = 0;
  double deviation = 0;  ///< rows, standard deviation
  double clearness = 0;  ///< edges shared by both sides before the end over those behind it
};

/// The row where edges end, to a few rows, seen from the last row within the image.
/// @param edges  size of each row's edges
/// @param ended  of the edges before the end, what remains behind it at most
PipetteEnd coarseEnd(const PipetteStrip& strip, const std::vector<double>& edges, double ended);

/// Of a tip of any shape before an empty background: the first row, from behind, whose edges are
/// half as large as those of the rows that follow.
/// @param half_width  columns
PipetteEnd pointNear(const PipetteStrip& strip, double coarse, double reach, int half_width);

/// Of a cut tube, before any background, to a few rows: the row whose profile across has half the
/// size that the rows just before it have, seen from the shaft.
/// @param half_width  columns
PipetteEnd tubeNear(const PipetteStrip& strip, double coarse, double reach, int half_width);

/// Of a cut tube whose contrast fades linearly, from a place within 14 rows: to a fraction of a row.
PipetteEnd tipNear(const PipetteStrip& strip, double coarse, int half_width);

/// Growth of the edges' rms distance from the axis over the rows behind an end.
double widening(const PipetteStrip& strip, double end, int half_width);

/// Of a blunt mouth: the outermost edge of the lip, from the outer parts of both sides, up to
/// `half_width` columns from the axis.
/// @param slant  result: rows per column, of the mouth's line
PipetteEnd mouthNear(const PipetteStrip& strip, double coarse, double half_width, double reach, double& slant);

}  // namespace microinjection
