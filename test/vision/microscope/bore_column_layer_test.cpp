#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "base/errors.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/tongue_outline.h"

namespace microinjection {
namespace {

constexpr double kBoreLength = 12e-6, kBoreRadius = 3e-6;  // m

MicroscopeScene needleScene() {
  MicroscopeScene scene;
  scene.injection = InjectionPipette();
  scene.injection->tip_radius = 4e-6;
  return scene;
}

/// px, from where on the column changes the light along the needle's axis, seen from the shaft.
double endOfColumn(Microscope& microscope, const BoreColumn& column) {
  MicroscopeScene scene = needleScene();
  const cv::Mat empty = microscope.transmission(scene, 0);
  scene.injection->column = column;
  cv::Mat change;
  cv::divide(microscope.transmission(scene, 0), empty, change);
  const Eigen::Vector2d tip = microscope.config().camera.pixelOf({0, 0});
  const int x = static_cast<int>(tip.x());
  const auto at = [&](int row) { return 0.5 * (change.at<float>(row, x) + change.at<float>(row, x + 1)); };
  // The darkest place is the rim, whose steepest slope towards the mouth is the border.
  double steepest = 0;
  int border = 0;
  for (int row = static_cast<int>(tip.y()) - 90; row < static_cast<int>(tip.y()) - 10; ++row) {
    if (at(row + 1) - at(row) <= steepest) continue;
    steepest = at(row + 1) - at(row);
    border = row;
  }
  return tip.y() - border - 0.5;
}

TEST(BoreColumnLayer, ItsBorderIsAtItsLength) {
  Microscope microscope{MicroscopeConfig()};
  const double length = kBoreLength / microscope.config().camera.pixel_size;
  BoreColumn column = BoreColumn::tongue(kBoreLength, kBoreRadius);
  column.optics.granules = 0;
  EXPECT_NEAR(endOfColumn(microscope, column), length, 1);
  column = BoreColumn::cytoplasm(kBoreLength, kBoreRadius);
  column.optics.granules = 0;
  EXPECT_NEAR(endOfColumn(microscope, column), length, 1);
}

TEST(BoreColumnLayer, ChangesNothingOutsideOfTheBore) {
  Microscope microscope{MicroscopeConfig()};
  MicroscopeScene scene = needleScene();
  const cv::Mat empty = microscope.transmission(scene, 0);
  scene.injection->column = BoreColumn::tongue(kBoreLength, kBoreRadius);
  const cv::Mat change = cv::abs(microscope.transmission(scene, 0) - empty);
  const Eigen::Vector2d tip = microscope.config().camera.pixelOf({0, 0});
  const double bore = kBoreRadius / microscope.config().camera.pixel_size;
  double within = 0, beside = 0;
  for (int y = 0; y < change.rows; ++y) {
    for (int x = 0; x < change.cols; ++x) {
      const double s = tip.y() - y, r = std::abs(x - tip.x());
      const bool near = s > -5 && s < 60 && r < bore + 0.06 * s + 5;
      (near ? within : beside) = std::max<double>(near ? within : beside, change.at<float>(y, x));
    }
  }
  EXPECT_GT(within, 0.1);
  EXPECT_EQ(beside, 0);
}

TEST(BoreColumnLayer, AColumnThatCannotBeIsRefused) {
  Microscope microscope{MicroscopeConfig()};
  MicroscopeScene scene = needleScene();
  scene.injection->column = BoreColumn::tongue(kBoreLength, kBoreRadius);
  scene.injection->column->bulge = 2 * kBoreRadius;
  EXPECT_THROW(microscope.transmission(scene, 0), ConfigError);
  scene.injection->column = BoreColumn();
  EXPECT_THROW(microscope.transmission(scene, 0), ConfigError);
}

TEST(TongueOutline, ReachesItsLengthAndKeepsTheRest) {
  const CellOutline circle = circleOutline({0, 0}, 50e-6, 360);
  // The mouth is below, on the circle's chord of its own width.
  DrawingMouth mouth{{0, -std::sqrt(50e-6 * 50e-6 - 15e-6 * 15e-6)}, {0, -1}, 15e-6, 10e-6};
  const CellOutline flat = withTongue(circle, mouth);
  double lowest = 0;
  for (const Eigen::Vector2d& corner : flat) {
    lowest = std::min(lowest, corner.y());
    const double away = corner.norm();
    if (std::abs(corner.x()) > 15.1e-6) EXPECT_NEAR(away, 50e-6, 1e-9);
  }
  EXPECT_NEAR(lowest, mouth.place.y() - 10e-6, 1e-9);
  mouth.length = 40e-6;  // a cylinder with half a sphere
  double widest = 0;
  for (const Eigen::Vector2d& corner : withTongue(circle, mouth)) {
    if (corner.y() < mouth.place.y() - 30e-6) widest = std::max(widest, std::abs(corner.x()));
  }
  EXPECT_NEAR(widest, std::sqrt(15e-6 * 15e-6 - 5e-6 * 5e-6), 0.3e-6);
  mouth.length = 6e-6;  // the circle reaches farther by itself
  mouth.place.y() += 5e-6;
  EXPECT_EQ(withTongue(circle, mouth), circle);
  mouth.place.x() = 200e-6;
  mouth.length = 40e-6;
  EXPECT_EQ(withTongue(circle, mouth), circle);
}

}  // namespace
}  // namespace microinjection
