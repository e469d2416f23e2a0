#pragma once

#include <optional>

#include "vision/layers/cell_detector.h"

namespace microinjection {

struct ZonaThickness {
  double thickness = 0;  ///< px, half of the difference of the borders' mean diameters
  double deviation = 0;  ///< px, standard deviation
};

/// Thickness of the zona: to its inner border where that was found. Without a perivitelline gap the
/// dark rim of the ooplasm covers the inner border, which is then the ooplasm's: an uncertain inner
/// border within that rim, or none, counts as such, and the interval of 95 % reaches over the rim: a gap
/// that it hides cannot be told from none. None: no zona, or a border of it is uncertain.
std::optional<ZonaThickness> zonaThickness(const CellDetection& cell);

}  // namespace microinjection
