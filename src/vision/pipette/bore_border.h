#pragma once

#include <opencv2/core.hpp>

#include "vision/frame/frame.h"
#include "vision/pipette/pipette_detection.h"

namespace microinjection {

/// Where to look for a border in a bore, and how it looks.
struct BoreView {
  double middle = 0;      ///< px, half width of the bore's middle that is read: about a third of its radius
  double place = 0;       ///< of the border in its dark rim: 0 on the side of the mouth, 1 on that of the shaft
  double mouth = 0;       ///< px behind the end, that the edge of the mouth darkens
  double least_rim = 0;   ///< depth of the dark rim over the grey value, below which nothing is seen
  double sure_rim = 0;    ///< the same, below which it is faint
  double widest_rim = 0;  ///< px
  int one_border = 0;     ///< px, within which what is seen is one border
  bool has_line = true;   ///< a bright line lies beside the rim, on the side of the mouth
  bool is_cell = false;   ///< the border is that of the held cell, which goes on beside the bore
};

/// The end of what a pipette has drawn in: the cap of a tongue, or the border between cytoplasm and liquid.
struct BoreBorder {
  Finding finding;
  double length = 0;     ///< px along the axis, from the pipette's end to the middle of the border
  double deviation = 0;  ///< px, standard deviation, with that of the pipette's end
  cv::Point2d place;     ///< px
};

/// Finds the border that lies across a pipette's bore, by the grey values of the bore's middle along the axis:
///
///     grey   ------.      .--------  a line, and
///                  |.-.   |          a step at the border, the dark rim beside it and the bright line,
///                  '  '---'          all with one blur
///            mouth    L   L + w   --> shaft
///
/// The position L, the rim's width w and the blur are those that leave the least squares of what remains; all else is
/// linear. A border of a cell behind or before the pipette crosses the glass and goes on beside it, where that of a
/// column ends at the wall. So what is seen beside the pipette, too, is not taken, unless it is the held cell's.
///
/// Not found where nothing like it is seen; uncertain where it is faint, or another place looks nearly like it. Only
/// a dark rim in bright field is known: in DIC and phase nothing is sure.
BoreBorder findBoreBorder(const Frame& frame, const PipetteDetection& pipette, const BoreView& view);

/// The same in a needle, whose column begins at its tip.
BoreBorder findColumn(const Frame& frame, const PipetteDetection& injection);

/// The tongue of a cell in a holding pipette. `has_zona`: its border is in the middle of its dark rim; without one it
/// is at the outer flank.
BoreBorder findTongue(const Frame& frame, const PipetteDetection& holding, bool has_zona);

}  // namespace microinjection
