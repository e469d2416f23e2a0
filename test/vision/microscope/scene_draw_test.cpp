#include "vision/microscope/scene_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/errors.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

CameraView turnedView() {
  CameraView view;
  view.angle = 0.4;
  view.mirrored = true;
  return view;
}

SceneDrawConfig everything() {
  SceneDrawConfig config;
  config.polar_body = config.nucleus = config.holding = config.injection = config.dimple = 1;
  config.bubbles = 3;
  return config;
}

/// Area and centroid of a polygon in px.
void areaOf(const CellOutline& outline, const CameraView& view, double& area, Eigen::Vector2d& centre) {
  std::vector<cv::Point2f> points;
  for (const auto& corner : outline) {
    const Eigen::Vector2d pixel = view.pixelOf(corner) - view.origin;
    points.emplace_back(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  }
  const cv::Moments moments = cv::moments(points);
  area = std::abs(moments.m00);
  centre = view.origin + Eigen::Vector2d(moments.m10, moments.m01) / moments.m00;
}

TEST(SceneDraw, TheSameSeedGivesTheSameScene) {
  const CameraView view = turnedView();
  const DrawnScene a = drawScene(everything(), view, 3), b = drawScene(everything(), view, 3),
                   c = drawScene(everything(), view, 4);
  EXPECT_EQ(a.scene.cells[0].zona_outer, b.scene.cells[0].zona_outer);
  EXPECT_EQ(a.truth.injection->end, b.truth.injection->end);
  EXPECT_EQ(a.scene.debris.size(), b.scene.debris.size());
  EXPECT_NE(a.truth.cell->centre, c.truth.cell->centre);
}

TEST(SceneDraw, TheTruthIsThatOfTheOutlines) {
  const CameraView view = turnedView();
  SceneDrawConfig config = everything();
  config.dimple = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const DrawnScene drawn = drawScene(config, view, seed);
    const CellScene& cell = drawn.scene.cells[0];
    const CellTruth& truth = *drawn.truth.cell;
    double area = 0;
    Eigen::Vector2d centre;
    areaOf(cell.zona_outer, view, area, centre);
    EXPECT_LT((centre - truth.centre).norm(), 0.01) << seed;
    EXPECT_NEAR(2 * std::sqrt(area / M_PI), truth.diameter, 2e-4 * truth.diameter) << seed;
    EXPECT_NEAR(truth.outer.x() * truth.outer.y(), truth.diameter * truth.diameter / 4, 1e-6 * area) << seed;
    areaOf(cell.zona_inner, view, area, centre);
    EXPECT_NEAR(M_PI * truth.zona_inner.x() * truth.zona_inner.y(), area, 1e-3 * area) << seed;
    // Every corner is on the ellipse that the truth has.
    const Eigen::Vector2d axis(std::cos(truth.angle), std::sin(truth.angle));
    for (const auto& corner : cell.zona_outer) {
      const Eigen::Vector2d from = view.pixelOf(corner) - truth.centre;
      const double along = from.dot(axis) / truth.outer.x(),
                   across = (axis.x() * from.y() - axis.y() * from.x()) / truth.outer.y();
      ASSERT_NEAR(std::hypot(along, across), 1, 1e-9) << seed;
    }
    const Eigen::Vector2d body = view.pixelOf(cell.polar_body->centre) - truth.centre;
    EXPECT_NEAR(std::remainder(std::atan2(body.y(), body.x()) - *truth.polar_body_angle, 2 * M_PI), 0, 1e-9) << seed;
    EXPECT_GT(truth.diameter * view.pixel_size, 59.9e-6);
    EXPECT_LT(truth.diameter * view.pixel_size, 140.1e-6);
  }
}

TEST(SceneDraw, ADimpleIsAsDeepAsItsTruth) {
  const CameraView view = turnedView();
  SceneDrawConfig config = everything();
  for (int seed = 0; seed < 20; ++seed) {
    const DrawnScene drawn = drawScene(config, view, seed);
    const CellTruth& truth = *drawn.truth.cell;
    const PipetteTruth& needle = *drawn.truth.injection;
    ASSERT_TRUE(truth.dimple_depth) << seed;
    EXPECT_LT((truth.dimple - needle.end).norm(), 1e-9) << seed;
    // The border's distance from the dimple, and that of the ellipse along the needle.
    double nearest = 1e9;
    for (const auto& corner : drawn.scene.cells[0].zona_outer)
      nearest = std::min(nearest, (view.pixelOf(corner) - truth.dimple).norm());
    EXPECT_LT(nearest, 1) << seed;
    const double c = std::cos(truth.angle), s = std::sin(truth.angle);
    const double along = (c * needle.axis.x() + s * needle.axis.y()) / truth.outer.x();
    const double across = (-s * needle.axis.x() + c * needle.axis.y()) / truth.outer.y();
    const double undeformed = 1 / std::hypot(along, across);
    EXPECT_NEAR(undeformed - (truth.dimple - truth.centre).dot(needle.axis), *truth.dimple_depth, 1e-6) << seed;
  }
}

TEST(SceneDraw, HasWhatIsAskedFor) {
  const CameraView view;
  SceneDrawConfig config;
  config.cell = config.holding = config.injection = 0;
  config.dust = 0;
  const DrawnScene empty = drawScene(config, view, 1);
  EXPECT_TRUE(empty.scene.cells.empty() && !empty.scene.holding && !empty.scene.injection &&
              empty.scene.debris.empty());
  EXPECT_FALSE(empty.truth.cell || empty.truth.holding || empty.truth.injection);
  config.holding = config.injection = 1;
  const DrawnScene pipettes = drawScene(config, view, 1);
  EXPECT_TRUE(pipettes.scene.holding && pipettes.scene.injection && pipettes.truth.holding && pipettes.truth.injection);
  config.cell = 1;
  config.centred = true;
  const DrawnScene centred = drawScene(config, view, 1);
  EXPECT_EQ(centred.truth.cell->centre, view.origin);
  EXPECT_EQ(centred.truth.cell->outer.x(), centred.truth.cell->outer.y());
}

TEST(SceneDraw, RefusesBadIntervals) {
  SceneDrawConfig config;
  config.diameter = {100e-6, 60e-6};
  config.cell = 2;
  try {
    drawScene(config, CameraView(), 1);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("diameter"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("cell = 2"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
