#include <gtest/gtest.h>

#include <vector>

#include "cell/model/puncture_drive.h"

namespace microinjection {
namespace {

/// The hole stays: within a tip's radius there is no zona, elsewhere there is.
TEST(PunctureHoles, RemembersItsHoles) {
  PunctureDrive drive(oocyte());
  drive.toDepth(15e-6);  // zona only
  drive.toDepth(-5e-6);
  drive.largest = 0;
  drive.moveTo({2e-6, 0, kTop + 5e-6});
  EXPECT_NEAR(drive.toDepth(1.8e-6), kFriction, 1e-12);  // at rest the oolemma is 2 um below the zona
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_NEAR(drive.toDepth(7e-6), kFriction + 0.02 * 5e-6, 1e-12);
  drive.toDepth(12.1e-6);
  EXPECT_EQ(drive.layers(), 2);
  EXPECT_LT(drive.largest, 0.3e-6);
  drive.toDepth(-5e-6);
  drive.toDepth(15e-6);  // nothing left
  EXPECT_NEAR(drive.force.z(), kFriction, 1e-12);
  EXPECT_EQ(drive.layers(), 2);
  drive.toDepth(-5e-6);
  drive.moveTo({-4e-6, 0, kTop + 5e-6});
  drive.toDepth(9e-6);
  EXPECT_GT(drive.force.z(), 0.8e-6);
  EXPECT_EQ(drive.cell->deformedSurface().holes.size(), 1u);
  drive.toDepth(12e-6);
  EXPECT_EQ(drive.layers(), 1);
  EXPECT_EQ(drive.cell->deformedSurface().holes.size(), 2u);
}

/// However often: the oldest of very many holes are forgotten, the newest never.
TEST(PunctureHoles, ManyHolesAreBounded) {
  PunctureConfig config = PunctureConfig::atForce(0.1e-6);
  Scene scene = sceneOf(config);
  scene.needle.tip.radius = 0.1e-6;
  PuncturableCell cell(scene, std::make_unique<SpringCell>(kRadius, kStiffness));
  double time = 0;
  const auto punch = [&](double x) {
    double largest = 0;
    for (int i = 0; i < 200; ++i) {
      const double height = kTop + 0.1e-6 * (i < 100 ? -i : i - 200);
      largest = std::max(largest, cell.step({x, 0, height}, kAxis, time += 0.1).force.z());
    }
    return largest;
  };
  for (int i = 0; i < 70; ++i) EXPECT_GT(punch(0.3e-6 * (i - 35)), 0.09e-6);
  EXPECT_EQ(cell.deformedSurface().holes.size(), static_cast<std::size_t>(PunctureHoles::kMost));
  EXPECT_EQ(punch(0.3e-6 * 34), 0);
  EXPECT_GT(punch(0.3e-6 * -35), 0.09e-6);
}

/// Over a slope the tip is in an old hole as soon as it is in the cell, on the uphill side as well: a way out sideways
/// from just there meets no cell that is dented already.
TEST(PunctureHoles, SidewaysOutOfAHoleIsNoKick) {
  PunctureConfig config = PunctureConfig::atForce(0.5e-6);
  config.shaft.lateral_stiffness = 0.01;
  PunctureDrive drive(config);
  drive.moveTo({20e-6, 0, kTop});
  drive.moveTo({20e-6, 0, 10e-6});
  ASSERT_EQ(drive.layers(), 1);
  drive.moveTo({20e-6, 0, kTop});
  drive.rest(0.1);
  drive.largest = 0;
  Eigen::Vector3d last = drive.force;
  double jump = 0;
  drive.moveTo({17.5e-6, 0, kTop});
  const std::vector<Eigen::Vector3d> way = {{17.5e-6, 0, 21.7e-6}, {14e-6, 0, 21.7e-6}, {14e-6, 0, 26e-6}};
  for (const Eigen::Vector3d& goal : way) {
    for (int i = 0; i < 1000; ++i) {
      drive.moveTo(drive.tip + (goal - drive.tip) / (1000 - i), 1);
      jump = std::max(jump, (drive.force - last).norm());
      last = drive.force;
    }
  }
  EXPECT_LT(jump, 0.4 * 0.01 * 3.5e-6);  // what fades in a step of the sideways force at the exit
  EXPECT_FALSE(drive.cell->insertion().inside);
  EXPECT_EQ(drive.rest(0.05), 0);
}

/// Beside the cell the needle is out, wherever it came in.
TEST(PunctureHoles, LateralExitLeavesTheCell) {
  PunctureConfig config = oocyte();
  config.shaft.lateral_stiffness = 0.01;
  PunctureDrive drive(config);
  drive.toDepth(25e-6);
  drive.moveTo({10e-6, 0, kTop - 25e-6});
  EXPECT_NEAR(drive.force.x(), -0.01 * 10e-6, 1e-15);
  EXPECT_TRUE(drive.cell->insertion().inside);
  drive.moveTo({30e-6, 0, kTop - 25e-6});
  EXPECT_FALSE(drive.cell->insertion().inside);
  EXPECT_TRUE(drive.rest(0.1) == 0 && drive.force.isZero(0));
  EXPECT_GE(drive.least_work, 0);
}

}  // namespace
}  // namespace microinjection
