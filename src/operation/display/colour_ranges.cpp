#include "operation/display/colour_ranges.h"

#include <algorithm>
#include <cstddef>

namespace microinjection {

bool CellIdentity::operator==(const CellIdentity& other) const {
  return parameters == other.parameters && values == other.values && radii == other.radii && material == other.material;
}

void ColourRanges::setCell(const CellIdentity& cell) {
  if (cell == cell_) return;
  cell_ = cell;
  ends_ = {};
  tension_ = 0;
}

double ColourRanges::include(SurfaceQuantity quantity, const std::vector<double>& values) {
  double& end = ends_[static_cast<std::size_t>(quantity)];
  end = std::max(end, scaleEnd(quantity, values));
  return end;
}

double ColourRanges::includeTension(double tension) { return tension_ = std::max(tension_, tension); }

}  // namespace microinjection
