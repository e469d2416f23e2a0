#include "vision/measurement/cell_offset.h"

#include <cmath>

namespace microinjection {

std::optional<CellOffset> cellOffset(const CellDetection& cell, const PipetteDetection& holding) {
  if (!cell.finding.isFound() || !holding.finding.isFound()) return std::nullopt;
  const Eigen::Vector2d axis(std::cos(holding.direction), std::sin(holding.direction));  // from the mouth to the shaft
  const Eigen::Vector2d right(axis.y(), -axis.x());                                      // y is down
  const Eigen::Vector2d away(cell.centre.x - holding.end.x, cell.centre.y - holding.end.y);
  const double turn = away.dot(axis) * holding.direction_deviation;  // what the axis' direction moves at the cell
  const double variance = right.dot((cell.centre_covariance + holding.covariance) * right) + turn * turn;
  return CellOffset{away.dot(right), std::sqrt(variance)};
}

}  // namespace microinjection
