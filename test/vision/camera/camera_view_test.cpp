#include "vision/camera/camera_view.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

CameraView viewOf(const std::string& yaml) {
  ConfigReader reader(YAML::Load(yaml), "test");
  const CameraView view = CameraView::read(reader);
  reader.finish();
  return view;
}

std::string errorOf(const std::string& yaml) {
  try {
    viewOf(yaml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CameraView, AnUprightViewHasXToTheRightAndZUp) {
  CameraView view;
  view.pixel_size = 0.5e-6;
  view.origin = {100, 200};
  EXPECT_TRUE(view.pixelOf({0, 0}).isApprox(Eigen::Vector2d(100, 200)));
  EXPECT_TRUE(view.pixelOf({10e-6, 0}).isApprox(Eigen::Vector2d(120, 200)));
  EXPECT_TRUE(view.pixelOf({0, 10e-6}).isApprox(Eigen::Vector2d(100, 180)));
}

TEST(CameraView, ARotationTurnsCounterClockwiseOnTheScreen) {
  CameraView view;
  view.pixel_size = 1e-6;
  view.origin = {0, 0};
  view.angle = M_PI / 6;
  const Eigen::Vector2d x = view.pixelOf({1e-6, 0}), z = view.pixelOf({0, 1e-6});
  EXPECT_NEAR((x - Eigen::Vector2d(std::cos(M_PI / 6), -0.5)).norm(), 0, 1e-12);
  EXPECT_NEAR((z - Eigen::Vector2d(-0.5, -std::cos(M_PI / 6))).norm(), 0, 1e-12);
}

TEST(CameraView, AMirrorSwapsLeftAndRightBeforeTheRotation) {
  CameraView view;
  view.pixel_size = 1e-6;
  view.origin = {0, 0};
  view.mirrored = true;
  EXPECT_NEAR((view.pixelOf({1e-6, 2e-6}) - Eigen::Vector2d(-1, -2)).norm(), 0, 1e-12);
  view.angle = M_PI / 2;
  EXPECT_NEAR((view.pixelOf({1e-6, 2e-6}) - Eigen::Vector2d(-2, 1)).norm(), 0, 1e-12);
}

TEST(CameraView, GoesThereAndBackInEveryOrientation) {
  for (const bool mirrored : {false, true}) {
    for (const double angle : {0.0, 0.3, M_PI / 2, 2.5, -1.0, M_PI}) {
      CameraView view;
      view.angle = angle;
      view.mirrored = mirrored;
      view.pixel_size = 0.186e-6;
      view.origin = {401.25, -37.5};
      for (const Eigen::Vector2d& world : {Eigen::Vector2d(0, 0), Eigen::Vector2d(31e-6, -7e-6)}) {
        EXPECT_NEAR((view.worldOf(view.pixelOf(world)) - world).norm(), 0, 1e-18);
      }
      // A metre is as many pixels in each direction, and only a mirror keeps the sense of rotation.
      const Eigen::Matrix2d map = view.pixelsPerMetre();
      EXPECT_NEAR((map * map.transpose() * view.pixel_size * view.pixel_size - Eigen::Matrix2d::Identity()).norm(), 0,
                  1e-12);
      EXPECT_EQ(map.determinant() > 0, mirrored);
      EXPECT_NEAR((view.imageDirection({0, 2}) - view.pixel_size * map.col(1)).norm(), 0, 1e-12);
    }
  }
}

TEST(CameraView, TheOriginIsTheMiddleUnlessGiven) {
  EXPECT_EQ(viewOf("{width: 640, height: 480}").origin, Eigen::Vector2d(319.5, 239.5));
  EXPECT_EQ(viewOf("{width: 640, height: 480, origin: [-10, 3]}").origin, Eigen::Vector2d(-10, 3));
}

TEST(CameraView, HasThePixelsOfItsImage) {
  const CameraView view = viewOf("{width: 640, height: 480}");
  EXPECT_TRUE(view.contains({0, 479}));
  EXPECT_FALSE(view.contains({-0.1, 10}));
  EXPECT_FALSE(view.contains({10, 479.1}));
}

TEST(CameraView, RefusesBadKeysAndValues) {
  EXPECT_NE(errorOf("{pixel_sise: 1.0e-6}").find("pixel_sise"), std::string::npos);
  EXPECT_NE(errorOf("{pixel_size: 0}").find("pixel_size = 0"), std::string::npos);
  EXPECT_NE(errorOf("{width: 0}").find("width = 0"), std::string::npos);
  EXPECT_NE(errorOf("{angle: 90}").find("angle = 90"), std::string::npos);
  EXPECT_NE(errorOf("{origin: [1, 2, 3]}").find("origin"), std::string::npos);
  CameraView view;
  view.pixel_size = NAN;
  view.height = 100000;
  try {
    view.validate();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("pixel_size = nan"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("height = 100000"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace microinjection
