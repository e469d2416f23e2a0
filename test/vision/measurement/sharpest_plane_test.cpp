#include "vision/measurement/sharpest_plane.h"

#include <gtest/gtest.h>

#include "vision/measurement/cell_measurement.h"
#include "vision/measurement/vision_config.h"
#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

constexpr double kPixel = 0.25e-6;  // m

/// A cell with a zona, whose equator is 3 um behind the world's origin, 2 um beside a holding pipette.
MicroscopeScene scene() {
  MicroscopeScene scene;
  scene.cells.push_back(CellScene::round({2e-6, 10e-6}, 37e-6, 6e-6, 0));
  scene.cells[0].y = 3e-6;
  HoldingPipette holder;
  holder.mouth = {0, -28e-6};
  holder.outer_radius = 30e-6;
  holder.inner_radius = 18e-6;
  holder.y = 3e-6;
  scene.holding = holder;
  return scene;
}

TEST(SharpestPlane, IsThatOfTheCellsEquator) {
  MicroscopeConfig config;
  Microscope microscope(config);
  SharpestPlane search{VisionConfig::standard().tracker};
  for (int plane = -12; plane <= 15; plane += 3)
    search.add({microscope.render(scene(), 1e-6 * plane, 50 + plane), std::nullopt, std::to_string(plane)});
  ASSERT_TRUE(search.best());
  EXPECT_FALSE(search.isAtAnEnd());
  EXPECT_EQ(search.planes(), 10U);
  EXPECT_EQ(search.best()->name, "3");
  EXPECT_EQ(search.best()->number, 6U);
  CellReadings readings(1);
  readings.add(search.best()->view);
  std::string reason;
  const auto cell = readings.measure(1, kPixel, reason);
  ASSERT_TRUE(cell) << reason;
  EXPECT_NEAR(cell->diameter.value, 74e-6, 0.3e-6);
  ASSERT_TRUE(cell->zona_thickness);
  EXPECT_NEAR(cell->zona_thickness->value, 6e-6, 0.4e-6);
  ASSERT_TRUE(cell->offset);
  EXPECT_NEAR(cell->offset->value, 2e-6, 0.5e-6);
}

TEST(SharpestPlane, KeepsTheReasonWhenNothingIsFound) {
  SharpestPlane search{VisionConfig::standard().tracker};
  EXPECT_FALSE(search.best());
  search.add({cv::Mat(300, 400, CV_8U, cv::Scalar(100)), std::nullopt, "grey"});
  ASSERT_TRUE(search.best());
  EXPECT_EQ(search.found(), 0U);
  EXPECT_FALSE(search.best()->view.cell.finding.reason.empty());
}

}  // namespace
}  // namespace microinjection
