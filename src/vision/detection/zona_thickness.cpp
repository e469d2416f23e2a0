#include "vision/detection/zona_thickness.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kRim = 1.25;  // over the mean width of the ooplasm's dark rim: one border and its blur

/// Whether a border was not seen at all, or within the ooplasm's rim.
bool isWithinRim(const CellBorder& border, const CellBorder& ooplasm) {
  if (!border.finding.hasValues()) return true;
  return (border.ellipse.meanDiameter() - ooplasm.ellipse.meanDiameter()) / 2 < kRim * ooplasm.rim;
}

}  // namespace

std::optional<ZonaThickness> zonaThickness(const CellDetection& cell) {
  if (!cell.zona_outer.finding.isFound()) return std::nullopt;
  const CellBorder* inner = &cell.zona_inner;
  if (!inner->finding.isFound()) {
    if (!cell.ooplasm.finding.isFound() || !isWithinRim(*inner, cell.ooplasm)) return std::nullopt;
    inner = &cell.ooplasm;
  }
  const double difference = cell.zona_outer.ellipse.meanDiameter() - inner->ellipse.meanDiameter();
  return ZonaThickness{difference / 2, std::sqrt(cell.zona_outer.covariance(2, 2) + inner->covariance(2, 2)) / 2};
}

}  // namespace microinjection
