#include "operation/teleoperation/frame_mapping.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/errors.h"

namespace microinjection {
namespace {

TEST(FrameMapping, TakesAxesByName) {
  FrameMappingConfig config;
  config.device_axes = "x -z y";  // phantom_omni: the device's y is up
  const FrameMapping frame(config);
  EXPECT_EQ(frame.toWorld({1, 2, 3}), Eigen::Vector3d(1, -3, 2));
  EXPECT_EQ(frame.toDevice({1, -3, 2}), Eigen::Vector3d(1, 2, 3)) << "forces go the other way";
}

TEST(FrameMapping, TurnsTheViewInTheWorld) {
  FrameMappingConfig config;
  config.view_rotation = {0, 0, M_PI / 2};  // the camera's right is the world's y
  const FrameMapping frame(config);
  EXPECT_LT((frame.toWorld({1, 0, 0}) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  config.device_axes = "x -z y";
  config.view_rotation = {0.3, -0.5, 1.1};
  const FrameMapping both(config);
  EXPECT_LT((both.toDevice(both.toWorld({1, 2, 3})) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-14);
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 3; ++i) rotation.col(i) = both.toWorld(Eigen::Vector3d::Unit(i));
  EXPECT_NEAR(rotation.determinant(), 1, 1e-12);
}

TEST(FrameMapping, RefusesWhatIsNoRotation) {
  for (const char* axes : {"", "x y", "x y z x", "x x z", "x z y", "-x y z", "x y w", "x y zz", "+x y z", "x,y,z"}) {
    YAML::Node map;
    map["device_axes"] = axes;
    ConfigReader reader(map, "test");
    FrameMappingConfig::read(reader);
    EXPECT_THROW(reader.finish(), ConfigError) << axes;
  }
}

}  // namespace
}  // namespace microinjection
