// Figures that the joint fit of a cell's borders reaches, on a few rendered images.

#include <gtest/gtest.h>

#include <cmath>

#include "vision/layers/cell_detector.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/scene_draw.h"

namespace microinjection {
namespace {

struct Seen {
  CellDetection cell;
  CellTruth truth;
};

Seen see(std::uint64_t seed, const std::string& look = "bright_field", double focus = 0, double gain = 40) {
  MicroscopeConfig microscope;
  microscope.contrast.mode = contrastModeOf(look);
  microscope.sensor.gain = gain;
  SceneDrawConfig draw;
  draw.dimple = 0;
  draw.holding = draw.injection = 1;
  const DrawnScene drawn = drawScene(draw, microscope.camera, seed);
  CellDetectorConfig config;
  config.smallest_diameter = 200;
  config.largest_diameter = 640;
  config.contrast_mode = contrastModeOf(look);
  const Frame frame(Microscope(microscope).render(drawn.scene, focus, seed));
  return {CellDetector(config).detect(frame), *drawn.truth.cell};
}

double meanDiameter(const Eigen::Vector2d& semi_axes) { return 2 * std::sqrt(semi_axes[0] * semi_axes[1]); }

/// px, of the mean radius.
double errorOf(const CellBorder& border, const Eigen::Vector2d& truth) {
  return 0.5 * std::abs(border.ellipse.meanDiameter() - meanDiameter(truth));
}

TEST(CellLayers, TheZonasInnerBorderIsSureBesideTheRim) {
  for (const std::uint64_t seed : {3, 7, 9, 12}) {
    const Seen seen = see(seed);
    ASSERT_TRUE(seen.cell.zona_inner.finding.isFound()) << seed << ": " << seen.cell.zona_inner.finding.reason;
    EXPECT_LT(errorOf(seen.cell.zona_inner, seen.truth.zona_inner), 0.5) << seed;
    ASSERT_TRUE(seen.cell.ooplasm.finding.isFound()) << seed << ": " << seen.cell.ooplasm.finding.reason;
    EXPECT_LT(errorOf(seen.cell.ooplasm, seen.truth.ooplasm), 0.5) << seed;
  }
}

TEST(CellLayers, DicShowsTheSameBorders) {
  for (const std::uint64_t seed : {3, 9, 15}) {
    const Seen seen = see(seed, "dic");
    ASSERT_TRUE(seen.cell.finding.isFound()) << seed << ": " << seen.cell.finding.reason;
    EXPECT_LT(std::hypot(seen.cell.centre.x - seen.truth.centre.x(), seen.cell.centre.y - seen.truth.centre.y()), 0.15);
    ASSERT_TRUE(seen.cell.zona_inner.finding.isFound()) << seed << ": " << seen.cell.zona_inner.finding.reason;
    EXPECT_LT(errorOf(seen.cell.zona_inner, seen.truth.zona_inner), 0.5) << seed;
  }
}

TEST(CellLayers, AnEllipseOnTwoLinesInDicIsNotSure) {
  // The outer line of one side and the inner line of the other make an ellipse that is as clear as the right one.
  for (const std::uint64_t seed : {119, 159, 593, 5058}) {
    const CellDetection cell = see(seed, "dic").cell;
    EXPECT_EQ(cell.finding.verdict, Verdict::kUncertain) << seed;
    EXPECT_EQ(cell.size.reason, "in DIC the border may be another line on each side") << seed;
  }
}

TEST(CellLayers, TheZonasOuterBorderIsFoundUnderNoise) {
  for (const std::uint64_t seed : {125, 130, 160, 183}) {
    const Seen seen = see(seed, "bright_field", 0, 8);
    ASSERT_TRUE(seen.cell.size.isFound()) << seed << ": " << seen.cell.size.reason;
    EXPECT_NEAR(seen.cell.outer().ellipse.meanDiameter(), seen.truth.diameter, 0.003 * seen.truth.diameter) << seed;
  }
}

TEST(CellLayers, OutOfFocusNoBorderIsSureAndFarOff) {
  for (const std::uint64_t seed : {2, 4, 13}) {
    const Seen seen = see(seed, "bright_field", 10e-6);
    if (seen.cell.ooplasm.finding.isFound()) EXPECT_LT(errorOf(seen.cell.ooplasm, seen.truth.ooplasm), 5) << seed;
    if (seen.cell.zona_inner.finding.isFound())
      EXPECT_LT(errorOf(seen.cell.zona_inner, seen.truth.zona_inner), 5) << seed;
  }
}

TEST(PolarBody, ItsAngleIsSureAndNoneIsClaimedWithoutOne) {
  for (const std::uint64_t seed : {7, 13, 19}) {
    const Seen seen = see(seed);
    ASSERT_TRUE(seen.truth.polar_body_angle);
    ASSERT_TRUE(seen.cell.polar_body.finding.isFound()) << seed << ": " << seen.cell.polar_body.finding.reason;
    EXPECT_LT(std::abs(std::remainder(seen.cell.polar_body.angle - *seen.truth.polar_body_angle, 2 * M_PI)), 0.01);
  }
  for (const std::uint64_t seed : {3, 14, 15}) {
    const Seen seen = see(seed);
    ASSERT_FALSE(seen.truth.polar_body_angle);
    EXPECT_FALSE(seen.cell.polar_body.finding.isFound()) << seed;
  }
}

}  // namespace
}  // namespace microinjection
