#include "vision/track/cell_hold.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

CellDetection cellAt(const cv::Point2d& centre, double radius) {
  CellDetection cell;
  cell.finding = cell.size = cell.zona_outer.finding = Finding::found();
  cell.centre = cell.zona_outer.ellipse.centre = centre;
  cell.zona_outer.ellipse.semi_axes = {radius, radius};
  cell.centre_covariance = 0.04 * Eigen::Matrix2d::Identity();
  return cell;
}

/// Its shaft goes down from the place.
PipetteDetection mouthAt(const cv::Point2d& place) {
  PipetteDetection pipette;
  pipette.finding = Finding::found();
  pipette.end = place;
  pipette.direction = M_PI / 2;
  pipette.half_width = 60;
  return pipette;
}

TEST(CellHold, IsWhetherTheOutlineReachesTheMouth) {
  const CellDetection cell = cellAt({300, 200}, 100);
  const CellHold held = cellHold(cell, mouthAt({300, 290}));
  EXPECT_TRUE(held.finding.isFound());
  EXPECT_TRUE(held.held);
  EXPECT_NEAR(held.gap, -10, 1e-6);
  const CellHold lost = cellHold(cell, mouthAt({300, 320}));
  EXPECT_TRUE(lost.finding.isFound());
  EXPECT_FALSE(lost.held);
  EXPECT_NEAR(lost.gap, 20, 1e-6);
  EXPECT_FALSE(cellHold(cell, mouthAt({300, 304.1})).finding.isFound());  // too near to tell
  const CellHold aside = cellHold(cell, mouthAt({450, 250}));             // its axis misses the cell
  EXPECT_TRUE(aside.finding.isFound());
  EXPECT_FALSE(aside.held);
  EXPECT_GT(aside.gap, 50);
}

TEST(CellHold, IsNotKnownOfWhatIsNotSeen) {
  EXPECT_EQ(cellHold(CellDetection(), mouthAt({300, 290})).finding.verdict, Verdict::kNotFound);
  EXPECT_EQ(cellHold(cellAt({300, 200}, 100), PipetteDetection()).finding.verdict, Verdict::kNotFound);
  CellDetection doubted = cellAt({300, 200}, 100);
  doubted.size = Finding::uncertain("it is bent");
  EXPECT_EQ(cellHold(doubted, mouthAt({300, 320})).finding.reason, "it is bent");
}

}  // namespace
}  // namespace microinjection
