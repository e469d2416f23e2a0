#include "vision/microscope/pipette_layer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vision/microscope/microscope.h"

namespace microinjection {
namespace {

/// Looks of a bar that absorbs half of the light between the inner walls, and nothing else.
const PipetteOptics kBar{0, -0.5, 0.4, 0.5, 0, 1e-12};

MicroscopeConfig pipetteConfig() {
  MicroscopeConfig config;
  config.camera.width = 300;
  config.camera.height = 240;
  config.camera.origin = {149.5, 119.5};
  return config;
}

InjectionPipette barAt(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis) {
  InjectionPipette pipette;
  pipette.tip = tip;
  pipette.axis = axis.normalized();
  pipette.tip_radius = 5e-6;
  pipette.wall = 0.2;
  pipette.taper = 0;
  pipette.optics = kBar;
  return pipette;
}

/// Sum of the absorbed shares over part of a row or a column: the length of the bar in it.
double lengthIn(const cv::Mat& transmission, const cv::Range& rows, const cv::Range& columns) {
  const cv::Mat part = transmission(rows, columns);
  return (static_cast<double>(part.total()) - cv::sum(part)[0]) / 0.5;
}

TEST(PipetteLayer, TheTipIsWhereItIs) {
  Microscope microscope(pipetteConfig());
  for (const double shift : {0.0, 0.13, 0.5, 0.77}) {
    for (const double focus : {0.0, 5e-6}) {
      MicroscopeScene scene;
      scene.injection = barAt({0, 0, shift * 0.25e-6}, {0, 0, 1});  // upwards from row 119.5 - shift
      const cv::Mat image = microscope.transmission(scene, focus);
      // In the middle column the bar has its full darkness, and ends between rows 60 and 180.
      const double length = lengthIn(image, cv::Range(60, 180), cv::Range(149, 150));
      EXPECT_NEAR(length, 119.5 - shift - 59.5, 0.02) << shift << " " << focus;
      EXPECT_NEAR(lengthIn(image, cv::Range(50, 51), cv::Range(0, 300)), 2 * 4 / 0.25, 0.02) << shift << " " << focus;
    }
  }
}

TEST(PipetteLayer, FollowsItsAxisInATurnedAndMirroredView) {
  MicroscopeConfig config = pipetteConfig();
  config.camera.angle = 0.5;
  config.camera.mirrored = true;
  Microscope microscope(config);
  MicroscopeScene scene;
  scene.injection = barAt({2e-6, 0, 1e-6}, {0.3, 0, 1});
  const cv::Mat image = microscope.transmission(scene, 0);
  const Eigen::Vector2d tip = config.camera.pixelOf({2e-6, 1e-6}), axis = config.camera.imageDirection({0.3, 1});
  // The centroid of the absorbed light in each row lies on the axis.
  for (const int row : {20, 40, 60}) {
    double sum = 0, first = 0;
    for (int x = 0; x < image.cols; ++x) {
      sum += 1 - image.at<float>(row, x);
      first += x * (1.0 - image.at<float>(row, x));
    }
    EXPECT_NEAR(first / sum, tip.x() + (row - tip.y()) * axis.x() / axis.y(), 0.02) << row;
  }
}

TEST(PipetteLayer, AnInclinedShaftLeavesTheFocus) {
  MicroscopeConfig config = pipetteConfig();
  config.objective.condenser_aperture = 0.3;
  Microscope microscope(config);
  MicroscopeScene scene;
  scene.injection = barAt({0, 0, 0}, {0, -1, 1});
  const cv::Mat image = microscope.transmission(scene, 0);
  const auto sharpest = [&](int row) {
    double slope = 0;
    for (int x = 1; x < image.cols; ++x)
      slope = std::max<double>(slope, std::abs(image.at<float>(row, x) - image.at<float>(row, x - 1)));
    return slope;
  };
  // At row 19.5 the axis is 25 um before the plane in focus: blurred by 3.75 um or 15 px.
  EXPECT_NEAR(sharpest(19), 0.5 / std::sqrt(2 * M_PI) / std::hypot(15, 1.2), 0.002);
  EXPECT_GT(sharpest(117), 0.1);
}

/// The mouth is where the round lips end: there half of the rim's light is gone, and none before.
TEST(PipetteLayer, TheMouthIsTheEndOfTheLips) {
  Microscope microscope(pipetteConfig());
  MicroscopeScene scene;
  scene.holding = HoldingPipette{};
  scene.holding->mouth = {0, -2.5e-6};  // row 129.5
  scene.holding->outer_radius = 20e-6;
  scene.holding->inner_radius = 10e-6;
  const cv::Mat image = microscope.transmission(scene, 0);
  // The middle of the right wall is 15 um or 60 px from the axis, and its lip has a radius of 20 px.
  EXPECT_NEAR(image.at<float>(124, 209), 1, 0.01);
  EXPECT_LT(image.at<float>(134, 209), 0.75);
  // Beside the middle of the wall the end lies behind the mouth.
  EXPECT_NEAR(image.at<float>(133, 226), 1, 0.03);
  EXPECT_LT(image.at<float>(150, 226), 0.75);
  // The lumen's mouth is straight.
  EXPECT_NEAR(image.at<float>(124, 160), 1, 0.01);
  EXPECT_LT(image.at<float>(132, 160), 0.9);
}

TEST(PipetteLayer, WallsAreDarkAndTheCoreIsBright) {
  for (const char* look : {"bright_field", "phase", "dic"}) {
    MicroscopeConfig config = pipetteConfig();
    config.contrast.mode = contrastModeOf(look);
    Microscope microscope(config);
    MicroscopeScene scene;
    scene.injection = InjectionPipette{};
    scene.injection->tip_radius = 3e-6;
    const cv::Mat image = microscope.transmission(scene, 0);
    const double radius = (3e-6 + 0.06 * 25e-6) / 0.25e-6;  // px, 100 rows above the tip
    const int wall = static_cast<int>(std::lround(0.87 * radius));
    EXPECT_GT(image.at<float>(19, 149), 1.2) << look;
    EXPECT_LT(image.at<float>(19, 149 - wall), 0.75) << look;
    EXPECT_LT(image.at<float>(19, 149 + wall), 0.75) << look;
  }
}

}  // namespace
}  // namespace microinjection
