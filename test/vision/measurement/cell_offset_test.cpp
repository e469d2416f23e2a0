#include "vision/measurement/cell_offset.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

CellDetection cellAt(double x, double y) {
  CellDetection cell;
  cell.finding = Finding::found();
  cell.centre = {x, y};
  return cell;
}

PipetteDetection holderAt(double x, double y, double direction) {
  PipetteDetection holder;
  holder.finding = Finding::found();
  holder.end = {x, y};
  holder.direction = direction;
  return holder;
}

TEST(CellOffset, IsPositiveToTheRightSeenFromShaftToMouth) {
  EXPECT_NEAR(cellOffset(cellAt(503, 300), holderAt(500, 400, M_PI / 2))->lateral, 3, 1e-9);    // from below
  EXPECT_NEAR(cellOffset(cellAt(503, 500), holderAt(500, 400, -M_PI / 2))->lateral, -3, 1e-9);  // from above
  EXPECT_NEAR(cellOffset(cellAt(600, 404), holderAt(500, 400, M_PI))->lateral, 4, 1e-9);        // from the left
}

TEST(CellOffset, HasTheDeviationsOfCentreMouthAndDirection) {
  CellDetection cell = cellAt(500, 300);
  PipetteDetection holder = holderAt(500, 400, M_PI / 2);
  cell.centre_covariance.diagonal() << 0.09, 100;  // what is along the axis does not count
  holder.covariance.diagonal() << 0.16, 100;
  EXPECT_NEAR(cellOffset(cell, holder)->deviation, 0.5, 1e-9);
  holder.direction_deviation = 0.012;  // 1.2 px at the cell
  EXPECT_NEAR(cellOffset(cell, holder)->deviation, 1.3, 1e-9);
}

TEST(CellOffset, NeedsBothForCertain) {
  CellDetection cell = cellAt(500, 300);
  PipetteDetection holder = holderAt(500, 400, M_PI / 2);
  holder.finding = Finding::uncertain("blurred");
  EXPECT_FALSE(cellOffset(cell, holder));
  holder.finding = Finding::found();
  cell.finding = Finding::notFound("dark");
  EXPECT_FALSE(cellOffset(cell, holder));
}

}  // namespace
}  // namespace microinjection
