#include "operation/teleoperation/virtual_fixtures.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kScale = 1e-3;

TEST(VirtualFixtures, AreOffByDefault) {
  const VirtualFixtures fixtures({}, kScale);
  const auto result = fixtures.apply({1, 2, -3});
  EXPECT_EQ(result.target, Eigen::Vector3d(1, 2, -3));
  EXPECT_EQ(result.hand_force, Eigen::Vector3d::Zero().eval());
}

TEST(VirtualFixtures, GuidePullsAcrossTheLineOnlyAndCanBeLeft) {
  VirtualFixturesConfig config;
  config.guide = true;
  config.guide_point = {1e-6, 0, 0};
  config.guide_axis = {0, 0, -3};
  const VirtualFixtures fixtures(config, kScale);
  EXPECT_LT(fixtures.apply({1e-6, 0, 50e-6}).hand_force.norm(), 1e-12) << "along the line";
  const auto off = fixtures.apply({3e-6, 0, 50e-6});  // 2 um: 2 mm of the hand
  EXPECT_LT((off.hand_force - Eigen::Vector3d(-config.guide_stiffness * 2e-3, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(off.target, Eigen::Vector3d(3e-6, 0, 50e-6)) << "it guides, it does not steer";
  EXPECT_NEAR(fixtures.apply({1e-3, 0, 0}).hand_force.norm(), config.guide_force, 1e-12);
}

TEST(VirtualFixtures, WallStopsTheNeedleAndPushesTheHand) {
  VirtualFixturesConfig config;
  config.wall = true;
  config.wall_point = {0, 0, -40e-6};
  config.wall_normal = {0, 0, 2};
  const VirtualFixtures fixtures(config, kScale);
  EXPECT_EQ(fixtures.apply({5e-6, 0, -39e-6}).hand_force, Eigen::Vector3d::Zero().eval());
  const auto past = fixtures.apply({5e-6, 0, -42e-6});
  EXPECT_LT((past.target - Eigen::Vector3d(5e-6, 0, -40e-6)).norm(), 1e-18);
  EXPECT_LT((past.hand_force - Eigen::Vector3d(0, 0, config.limit_stiffness * 2e-3)).norm(), 1e-12);
  EXPECT_NEAR(fixtures.apply({0, 0, -1}).hand_force.z(), config.limit_force, 1e-12);
}

TEST(VirtualFixtures, WorkspaceIsABox) {
  VirtualFixturesConfig config;
  config.workspace = true;
  const VirtualFixtures fixtures(config, kScale);
  const auto out = fixtures.apply({3e-3, -3e-3, 0});
  EXPECT_EQ(out.target, Eigen::Vector3d(2e-3, -2e-3, 0));
  EXPECT_LT(out.hand_force.x(), 0);
  EXPECT_GT(out.hand_force.y(), 0);
  EXPECT_EQ(out.hand_force.z(), 0);
}

TEST(VirtualFixtures, RefuseGeometryThatIsNone) {
  for (const auto& [yaml, error] : {std::pair("{guide: {axis: [0, 0, 0]}}", "guide/axis"),
                                    {"{wall: {normal: [0, 0, 0]}}", "wall/normal"},
                                    {"{workspace: {low: [-1, 1, -1], high: [1, 1, 1]}}", "workspace/low"}}) {
    ConfigReader reader(YAML::Load(yaml), "fixtures");
    VirtualFixturesConfig::read(reader);
    try {
      reader.finish();
      ADD_FAILURE() << yaml;
    } catch (const ConfigError& refusal) {
      EXPECT_NE(std::string(refusal.what()).find(error), std::string::npos) << refusal.what();
    }
  }
}

}  // namespace
}  // namespace microinjection
