#include "vision/track/hold_detection.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kFlattened = 0.02;  // of the diameter, that a held cell's outline may end before the mouth
constexpr double kIntervals = 3;     // standard deviations of the gap

}  // namespace

HoldDetection detectHold(const CellDetection& cell, const PipetteDetection& holding) {
  HoldDetection hold;
  hold.finding = Finding::notFound(cell.finding.hasValues() ? "no mouth was found" : "no cell was found");
  if (!cell.finding.hasValues() || !holding.finding.hasValues()) return hold;
  const CellBorder& outer = cell.outer();
  const Eigen::Vector2d axis(std::cos(holding.direction), std::sin(holding.direction));
  // Where the axis misses the cell, the nearest place of the outline counts.
  const std::optional<double> exit = outer.ellipse.exit(holding.end, holding.direction);
  hold.gap = exit ? -*exit : outer.ellipse.distance(holding.end);
  hold.deviation =
      std::sqrt(axis.dot((cell.centre_covariance + holding.covariance) * axis) + 0.25 * outer.covariance(2, 2));
  const double near = kFlattened * outer.ellipse.meanDiameter();
  hold.held = exit && hold.gap < near;
  hold.finding = Finding::found();
  if (std::abs(hold.gap - near) < kIntervals * hold.deviation)
    hold.finding = Finding::uncertain("the cell is very near the mouth");
  for (const Finding* part : {&cell.finding, &cell.size, &holding.finding}) {
    if (!part->isFound()) hold.finding = Finding::uncertain(part->reason);
  }
  return hold;
}

}  // namespace microinjection
