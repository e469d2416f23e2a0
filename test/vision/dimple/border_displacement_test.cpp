#include "vision/dimple/border_displacement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vision/layers/cell_detector.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

constexpr double kPixel = 0.25e-6, kRadius = 38e-6, kTipRadius = 3e-6;  // m

/// An oocyte that a flat tip indents by `depth` (m); a negative one is a tip above it. One that is not elastic stays
/// as it is: the needle is before it.
class PressedBall {
 public:
  explicit PressedBall(double depth, bool elastic = true) {
    MicroscopeConfig config;
    config.camera.pixel_size = kPixel;
    MicroscopeScene scene;
    CellScene cell = CellScene::round({0, 0}, kRadius, 6e-6, 2e-6);
    for (CellOutline* outline : {&cell.zona_outer, &cell.zona_inner, &cell.ooplasm}) {
      for (Eigen::Vector2d& corner : *outline) {
        const double side = std::abs(corner.x()), height = std::clamp(2 * corner.y() / kRadius, 0.0, 1.0);
        const double share = side < kTipRadius ? 1 : M_2_PI * std::asin(kTipRadius / side);
        if (elastic) corner.y() -= std::max(0.0, depth) * height * share;
      }
    }
    scene.cells.push_back(cell);
    InjectionPipette needle;
    needle.tip = {0, 0, kRadius - depth};
    needle.tip_radius = kTipRadius;
    needle.shaft_radius = 10e-6;
    scene.injection = needle;
    const Eigen::Vector2d place = config.camera.pixelOf({0, kRadius - depth});
    tip = {place.x(), place.y()};
    image = Microscope(config).render(scene, 0, 3);
  }

  BorderDisplacement find(double direction = -M_PI / 2) const {
    const Frame frame(image);
    const CellDetection cell = CellDetector(CellDetectorConfig()).detect(frame);
    EXPECT_TRUE(cell.finding.hasValues()) << cell.finding.reason;
    return findDisplacement(frame, cell.outer(), tip, direction);
  }

  cv::Mat image;
  cv::Point2d tip;
};

TEST(BorderDisplacement, IsThatOfTheOutline) {
  const double rest = PressedBall(-5e-6).find().depth;
  EXPECT_NEAR(rest, 0, 1.5);
  EXPECT_NEAR(PressedBall(-1e-6).find().depth, rest, 0.5);  // what is not the needle's stays the same
  for (const double depth : {1e-6, 2e-6, 3e-6}) {
    const BorderDisplacement found = PressedBall(depth).find();
    ASSERT_TRUE(found.finding.isFound()) << found.finding.reason;
    EXPECT_NEAR((found.depth - rest) * kPixel, depth, 0.35e-6 + 0.15 * depth);
    EXPECT_LT(found.deviation, 1);
  }
}

TEST(BorderDisplacement, HasTheGapToTheUndisturbedOutline) {
  for (const double depth : {-5e-6, -1e-6, 2e-6}) {
    EXPECT_NEAR(PressedBall(depth).find().gap * kPixel, -depth, 0.3e-6) << depth;
  }
}

TEST(BorderDisplacement, ANeedleBeforeTheCellDisplacesNothing) {
  const double rest = PressedBall(-5e-6).find().depth;
  EXPECT_NEAR(PressedBall(2e-6, false).find().depth, rest, 1);
}

TEST(BorderDisplacement, KnowsTheNeedlesWidth) {
  const PressedBall scene(-5e-6);
  EXPECT_NEAR(needleHalfWidth(Frame(scene.image), scene.tip, -M_PI / 2), kTipRadius / kPixel + 1, 2);
}

TEST(BorderDisplacement, IsNotFoundWithoutNeedleOrCell) {
  const PressedBall scene(-5e-6);
  EXPECT_FALSE(scene.find(0).finding.hasValues());  // it does not point at the cell
  const Frame empty(cv::Mat(400, 400, CV_8U, cv::Scalar(120)) + scene.image(cv::Rect(0, 0, 400, 400)) * 0.01);
  CellBorder border;
  border.ellipse = {{200, 260}, {100, 100}, 0};
  EXPECT_FALSE(findDisplacement(empty, border, {200, 150}, -M_PI / 2).finding.hasValues());
  // The needle is at the frame's border.
  border.ellipse = {{200, 105}, {100, 100}, 0};
  EXPECT_FALSE(findDisplacement(Frame(scene.image), border, {200, 3}, -M_PI / 2).finding.hasValues());
}

}  // namespace
}  // namespace microinjection
