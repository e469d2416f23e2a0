#pragma once

#include <optional>

#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// Radius over that of `base` of the clearest dark ring about it, between the ratios `low` and `high`; nothing without
/// one. All directions together show a line that noise hides in each of them. Sectors with a pipette or a neighbour do
/// not count, as long as they are less than half of all.
std::optional<double> findFaintRing(const Frame& frame, const Ellipse& base, double low, double high);

}  // namespace microinjection
