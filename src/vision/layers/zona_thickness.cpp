#include "vision/layers/zona_thickness.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kRim = 1.25;       // over the mean width of the ooplasm's dark rim: one border and its blur
constexpr double kNormal95 = 1.96;  // standard deviations, of the half width of a 95 % interval

/// Whether a border was not seen at all, or within the ooplasm's rim.
bool isWithinRim(const CellBorder& border, const CellBorder& ooplasm) {
  if (!border.finding.hasValues()) return true;
  return (border.ellipse.meanDiameter() - ooplasm.ellipse.meanDiameter()) / 2 < kRim * ooplasm.rim;
}

}  // namespace

std::optional<ZonaThickness> zonaThickness(const CellDetection& cell) {
  if (!cell.zona_outer.finding.isFound()) return std::nullopt;
  const CellBorder* inner = &cell.zona_inner;
  double hidden = 0;  // px, standard deviation of the place in the rim
  if (!inner->finding.isFound()) {
    if (!cell.ooplasm.finding.isFound() || !isWithinRim(*inner, cell.ooplasm)) return std::nullopt;
    inner = &cell.ooplasm;
    hidden = kRim * cell.ooplasm.rim / kNormal95;
  }
  const double difference = cell.zona_outer.ellipse.meanDiameter() - inner->ellipse.meanDiameter();
  const double borders = std::hypot(diameterDeviation(cell.zona_outer), diameterDeviation(*inner)) / 2;
  return ZonaThickness{difference / 2, std::hypot(borders, hidden)};
}

}  // namespace microinjection
