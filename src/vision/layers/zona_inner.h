#pragma once

#include "vision/border/cell_border.h"

namespace microinjection {

/// Standard deviation of a zona's change of thickness, over its radius.
constexpr double kZonaTilt = 0.006;

/// The zona's inner border: a thin dark line beside the ooplasm's rim. It is seen only where there is
/// a gap; a zona has nearly the same thickness everywhere, so what is seen there gives the rest.
/// kNotFound when the line is not seen, kUncertain when it is seen on too short an arc or faintly.
/// @param outer    the zona's outer border, refined
/// @param ooplasm  its border, refined
CellBorder findZonaInner(const Frame& frame, const CellBorder& outer, const CellBorder& ooplasm);

}  // namespace microinjection
