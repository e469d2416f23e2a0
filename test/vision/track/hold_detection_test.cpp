#include "vision/track/hold_detection.h"

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

TEST(HoldDetection, IsWhetherTheOutlineReachesTheMouth) {
  const CellDetection cell = cellAt({300, 200}, 100);
  const HoldDetection held = detectHold(cell, mouthAt({300, 290}));
  EXPECT_TRUE(held.finding.isFound());
  EXPECT_TRUE(held.held);
  EXPECT_NEAR(held.gap, -10, 1e-6);
  const HoldDetection lost = detectHold(cell, mouthAt({300, 320}));
  EXPECT_TRUE(lost.finding.isFound());
  EXPECT_FALSE(lost.held);
  EXPECT_NEAR(lost.gap, 20, 1e-6);
  EXPECT_FALSE(detectHold(cell, mouthAt({300, 304.1})).finding.isFound());  // too near to tell
  const HoldDetection aside = detectHold(cell, mouthAt({450, 250}));        // its axis misses the cell
  EXPECT_TRUE(aside.finding.isFound());
  EXPECT_FALSE(aside.held);
  EXPECT_GT(aside.gap, 50);
}

TEST(HoldDetection, IsNotKnownOfWhatIsNotSeen) {
  EXPECT_EQ(detectHold(CellDetection(), mouthAt({300, 290})).finding.verdict, Verdict::kNotFound);
  EXPECT_EQ(detectHold(cellAt({300, 200}, 100), PipetteDetection()).finding.verdict, Verdict::kNotFound);
  CellDetection doubted = cellAt({300, 200}, 100);
  doubted.size = Finding::uncertain("it is bent");
  EXPECT_EQ(detectHold(doubted, mouthAt({300, 320})).finding.reason, "it is bent");
}

}  // namespace
}  // namespace microinjection
