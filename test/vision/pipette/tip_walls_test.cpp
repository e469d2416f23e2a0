#include "vision/pipette/tip_walls.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

/// A needle alone, whose shaft is up in the image.
TipWalls wallsOf(const std::string& look, double tip_radius, double before) {
  MicroscopeConfig config;
  config.contrast.mode = contrastModeOf(look);
  MicroscopeScene scene;
  InjectionPipette needle;
  needle.tip = {0, 0, 0};
  needle.tip_radius = tip_radius;
  scene.injection = needle;
  Microscope microscope(config);
  const Eigen::Vector2d tip = config.camera.pixelOf({0, 0});
  return measureTipWalls(Frame(microscope.render(scene, 0, 1)), {tip.x(), tip.y() + before}, -M_PI / 2);
}

TEST(TipWalls, AreKeptUpToTheEnd) {
  for (const double radius : {0.6e-6, 1.5e-6, 3e-6}) EXPECT_GT(wallsOf("bright_field", radius, 0).kept, 0.3) << radius;
}

TEST(TipWalls, BeginBehindAPlaceThatIsNoEnd) {
  for (const double radius : {0.6e-6, 1.5e-6, 3e-6}) EXPECT_LT(wallsOf("bright_field", radius, 10).kept, 0.1) << radius;
}

TEST(TipWalls, AreShadedFromOneSideInDic) {
  for (const double radius : {0.6e-6, 1.5e-6, 3e-6}) {
    EXPECT_LT(wallsOf("bright_field", radius, 0).shading, 0.1) << radius;
    EXPECT_GT(wallsOf("dic", radius, 0).shading, 0.25) << radius;
  }
}

TEST(TipWalls, HaveTheWidthOfTheNeedle) {
  const double thin = wallsOf("bright_field", 0.6e-6, 0).half_width, wide = wallsOf("bright_field", 3e-6, 0).half_width;
  EXPECT_NEAR(wide - thin, (3e-6 - 0.6e-6) / MicroscopeConfig().camera.pixel_size, 2);
}

}  // namespace
}  // namespace microinjection
