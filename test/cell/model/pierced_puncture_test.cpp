#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell/model/puncture_drive.h"
#include "cell/model/spring_branch.h"

namespace microinjection {
namespace {

PunctureConfig tough() {
  PunctureConfig config;
  config.layers.emplace_back().toughness = 1;
  return config;
}

/// N, of the onset of the closed form: its depth is ((e + c) + sqrt((e + c)^2 - c^2)) / k.
double onsetForce(const SpringBranch& branch) {
  const double sum = branch.opened + branch.cost;
  return sum + std::sqrt(sum * sum - branch.cost * branch.cost);
}

TEST(PiercedPuncture, ForceFallsToTheSteadyOneAndStaysThere) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(40e-6);
  EXPECT_EQ(needle.layers(), 1);
  EXPECT_NEAR(needle.largest, onsetForce(branch), 2e-3 * onsetForce(branch));
  EXPECT_NEAR(needle.rest(0.05), branch.opened + branch.cost, 1e-3 * branch.cost);
  EXPECT_NEAR(needle.toDepth(45e-6), branch.opened + branch.cost, 1e-3 * branch.cost);
  EXPECT_GE(needle.least_work, 0);
}

TEST(PiercedPuncture, TheDentStaysAsDeepAsTheBranchHasIt) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(40e-6);
  needle.rest(0.05);
  ASSERT_TRUE(needle.spring->contact());
  EXPECT_NEAR(needle.spring->contact()->indentation, branch.cost / branch.spring, 0.05e-6);
  EXPECT_NEAR(needle.cell->insertion().depth, 40e-6, 1e-9);
}

TEST(PiercedPuncture, OnTheWayOutOnlyTheOpenedHolePushes) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(40e-6);
  needle.rest(0.05);
  EXPECT_NEAR(needle.toDepth(36e-6), branch.opened + branch.cost / 2, 0.01 * branch.opened) << "half of the dent";
  EXPECT_NEAR(needle.toDepth(31e-6), branch.opened, 0.01 * branch.opened);
  EXPECT_NEAR(needle.toDepth(10e-6), branch.opened, 0.01 * branch.opened);
  needle.toDepth(-1e-6);
  EXPECT_FALSE(needle.cell->insertion().inside);
  EXPECT_NEAR(needle.rest(0.1), 0, 1e-12);
  EXPECT_GE(needle.least_work, 0) << "the needle never gets back more than it gave";
}

TEST(PiercedPuncture, WallRubsOnTheShaft) {
  SpringBranch branch;
  branch.wall_force = 0.02;  // N/m
  PunctureConfig config = tough();
  config.shaft.coefficient = 0.5;
  PunctureDrive needle(config, 1000, branch.make());
  needle.toDepth(42e-6);
  needle.rest(0.05);
  needle.toDepth(45e-6);
  const double in = needle.rest(0.05), length = 45e-6 - branch.cost / branch.spring;
  EXPECT_NEAR(in - branch.opened - branch.cost, 0.5 * 0.02 * length, 0.03 * 0.5 * 0.02 * length);
  EXPECT_GE(needle.least_work, 0);
}

TEST(PiercedPuncture, WithoutAnOnsetItIsNotPierced) {
  SpringBranch branch;
  branch.cost = 20e-6;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(45e-6);
  EXPECT_EQ(needle.layers(), 0);
  PunctureDrive without(tough());
  without.toDepth(45e-6);
  EXPECT_EQ(without.layers(), 0);
}

TEST(PiercedPuncture, AShallowOnsetHasTheWholeForceOfItsHole) {
  SpringBranch branch;
  branch.opened = 0.1e-6;
  branch.cost = 0.01e-6;
  PunctureDrive needle(tough(), 1000, branch.make());
  const double onset = onsetForce(branch) / branch.spring;
  needle.toDepth(1.01 * onset);
  ASSERT_EQ(needle.layers(), 1);
  EXPECT_LT(onset, 1.5 * Scene().needle.tip.radius) << "within the hole's mouth";
  EXPECT_NEAR(needle.rest(0.05), branch.opened + branch.cost, 0.02 * branch.opened);
}

/// The force that is lost stays for long, so that a needle that withdraws at once gets all of it that it may.
TEST(PiercedPuncture, CrackAndBarrierAreNotReturned) {
  SpringBranch branch;
  branch.barrier = 10e-12;
  PunctureConfig config = tough();
  config.relaxation_time = 10;
  PunctureDrive needle(config, 1000, branch.make());
  while (needle.layers() == 0) needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  const double depth = kTop - needle.tip.z(), length = depth - branch.cost / branch.spring;
  needle.toDepth(-1e-6);
  EXPECT_GT(needle.work, branch.cost * length + branch.barrier);
}

/// A resealed hole breaks before the needle has given the energy that opens it.
TEST(PiercedPuncture, AResealedHoleReturnsNoMoreThanItGot) {
  const SpringBranch branch;
  PunctureConfig config = tough();
  config.resealing_time = 10;
  PunctureDrive needle(config, 1000, branch.make());
  needle.toDepth(30e-6);
  needle.toDepth(-1e-6);
  for (const double age : {0.1, 0.4, 2.0}) {
    needle.rest(age);
    needle.work = needle.least_work = 0;
    needle.toDepth(5e-6);
    EXPECT_TRUE(needle.cell->insertion().inside);
    needle.toDepth(-1e-6);
    EXPECT_GE(needle.least_work, 0) << age;
  }
}

TEST(PiercedPuncture, AMembraneBehindItFailsWithItsOwnForceOnly) {
  const SpringBranch branch;
  PunctureConfig config = tough();
  PunctureConfig::Layer& oolemma = config.layers.emplace_back();
  oolemma.name = "oolemma";
  oolemma.force = 0.2e-6;
  oolemma.stiffness = 0.02;
  PunctureDrive needle(config, 1000, branch.make());
  needle.toDepth(30e-6);
  needle.rest(0.05);
  ASSERT_EQ(needle.layers(), 1);
  needle.largest = 0;
  needle.toDepth(40e-6);
  ASSERT_EQ(needle.layers(), 2);
  const double steady = branch.opened + branch.cost;
  EXPECT_LT(needle.largest, 1.01 * (steady + oolemma.force));
  EXPECT_NEAR(needle.rest(0.05), steady, 0.01 * steady);
  needle.toDepth(-1e-6);
  EXPECT_GE(needle.least_work, 0);
}

/// In beside the hole's place, where the surface is lower, and out in its middle.
TEST(PiercedPuncture, ANeedleThatFindsItsHoleGetsNothingForIt) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(30e-6);
  needle.toDepth(-5e-6);
  for (int i = 0; i < 5; ++i) {
    needle.moveTo({2.5e-6, 0, kTop + 5e-6});
    needle.work = needle.least_work = 0;
    needle.moveTo({2.5e-6, 0, kTop - 0.2e-6});
    ASSERT_TRUE(needle.cell->insertion().inside);
    needle.moveTo({0, 0, kTop - 0.2e-6});
    needle.moveTo({0, 0, kTop + 5e-6});
    EXPECT_GE(needle.least_work, -1e-3 * branch.opened * 0.2e-6);
  }
}

TEST(PiercedPuncture, WithdrawnBeforeTheBreakItIsWhole) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(0.9 * onsetForce(branch) / branch.spring);
  needle.toDepth(-1e-6);
  EXPECT_EQ(needle.layers(), 0);
  EXPECT_NEAR(needle.work, 0, 1e-15);
}

}  // namespace
}  // namespace microinjection
