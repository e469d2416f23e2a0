#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cell/model/puncture_drive.h"
#include "cell/model/spring_branch.h"

namespace microinjection {
namespace {

PunctureConfig tough() {
  PunctureConfig config;
  config.layers.emplace_back().toughness = 1;
  return config;
}

/// The same with a membrane behind it. @param gap m, @param stiffness N/m, @param force N, at which it fails
PunctureConfig toughWithMembrane(double gap, double stiffness, double force) {
  PunctureConfig config = tough();
  PunctureConfig::Layer& membrane = config.layers.emplace_back();
  membrane.name = "oolemma";
  membrane.gap = gap;
  membrane.stiffness = stiffness;
  membrane.force = force;
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

TEST(PiercedPuncture, AFastNeedleMeetsATougherLayerUntilItRests) {
  PunctureConfig config = tough();
  config.layers.front().toughness_rate = {100e-6, 0.5};
  SpringBranch branch;
  branch.cost = 0.4e-6;
  double last = 0;
  for (const double speed : {1e-6, 25e-6, 100e-6, 200e-6}) {
    SpringBranch tougher = branch;
    tougher.cost *= 1 + std::sqrt(speed / 100e-6);
    PunctureDrive needle(config, 1000, branch.make());
    needle.toDepth(5e-6, speed);
    needle.toDepth(32e-6, speed);
    ASSERT_EQ(needle.layers(), 1);
    EXPECT_NEAR(needle.largest, onsetForce(tougher), 0.01 * onsetForce(tougher)) << speed;
    EXPECT_GT(needle.largest, last);
    last = needle.largest;
    EXPECT_NEAR(needle.toDepth(42e-6, speed), tougher.opened + tougher.cost, 0.01 * tougher.cost) << "on the way in";
    EXPECT_NEAR(needle.rest(0.2), branch.opened + branch.cost, 0.01 * branch.cost) << "the hole has grown at rest";
    needle.toDepth(-1e-6, speed);
    EXPECT_GE(needle.least_work, 0);
  }
}

TEST(PiercedPuncture, ANeedleThatIsTooFastIsNotThrough) {
  PunctureConfig config = tough();
  config.layers.front().toughness_rate = {1e-6, 2};
  PunctureDrive needle(config, 1000, SpringBranch().make());
  needle.toDepth(30e-6, 20e-6);
  EXPECT_EQ(needle.layers(), 0);
  needle.rest(0.1);
  EXPECT_EQ(needle.layers(), 1) << "a slow layer fails at this force";
}

TEST(PiercedPuncture, TheErrorIsKnownWhereTheForceIsThatOfASolution) {
  const SpringBranch branch;
  const auto errorOf = [](const PunctureDrive& needle) { return needle.cell->forceError(); };
  PunctureDrive needle(tough(), 1000, branch.make(), 0.03);
  EXPECT_FALSE(errorOf(needle));
  needle.spring->error = 1e-9;
  needle.toDepth(5e-6);
  EXPECT_EQ(errorOf(needle), 1e-9) << "that of the whole cell";
  while (needle.layers() == 0) needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  EXPECT_FALSE(errorOf(needle)) << "a lost force fades";
  needle.rest(0.1);
  EXPECT_NEAR(errorOf(needle).value(), 0.03 * (branch.opened + branch.cost), 1e-3 * 0.03 * branch.cost);
  PunctureConfig rubs = tough();
  rubs.shaft.friction = 1e-8;
  PunctureDrive other(rubs, 1000, branch.make(), 0.03);
  other.toDepth(42e-6);
  other.rest(0.1);
  EXPECT_FALSE(errorOf(other)) << "nobody has solved the shaft";
  PunctureDrive threshold(PunctureConfig::atForce(1e-6));
  threshold.spring->error = 1e-9;
  threshold.toDepth(20e-6);
  ASSERT_EQ(threshold.layers(), 1);
  threshold.rest(0.1);
  EXPECT_FALSE(errorOf(threshold)) << "springs stand for it";
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

/// 24 um below the surface at rest, in a dent of 8 um; the tip stretches it by 10 um, for which the dent gets 2 um
/// deeper.
TEST(PiercedPuncture, AMembraneBehindItIsMetWhereTheDeformedCellHasIt) {
  const SpringBranch branch;
  const PunctureConfig config = toughWithMembrane(24e-6, 0.02, 0.2e-6);
  const PunctureConfig::Layer& oolemma = config.layers.back();
  PunctureDrive needle(config, 1000, branch.make());
  const double dent = branch.cost / branch.spring, steady = branch.opened + branch.cost;
  needle.toDepth(25e-6);
  EXPECT_NEAR(needle.rest(0.05), steady, 0.01 * steady);
  EXPECT_NEAR(needle.toDepth(oolemma.gap + dent), steady, 0.01 * steady) << "not met yet";
  EXPECT_NEAR(needle.toDepth(oolemma.gap + dent + 6e-6), steady + 0.1e-6, 0.01 * steady) << "stretched by 5 um";
  ASSERT_EQ(needle.layers(), 1);
  needle.largest = 0;
  needle.toDepth(oolemma.gap + dent + 12.1e-6);
  ASSERT_EQ(needle.layers(), 2);
  EXPECT_NEAR(needle.largest, steady + oolemma.force, 0.01 * steady);
  EXPECT_NEAR(needle.rest(0.05), steady, 0.01 * steady);
  needle.toDepth(-1e-6);
  EXPECT_GE(needle.least_work, 0);
}

/// It is within the hole that the first crack makes.
TEST(PiercedPuncture, AWeakMembraneCloseBehindItFailsAtOnce) {
  const PunctureConfig config = toughWithMembrane(1e-6, 0.02, 0.05e-6);
  const SpringBranch branch;
  PunctureDrive needle(config, 1000, branch.make());
  while (needle.layers() == 0) needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  const double onset = needle.force.z(), steady = branch.opened + branch.cost;
  needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  EXPECT_EQ(needle.layers(), 2);
  EXPECT_GT(needle.force.z(), steady + 0.5 * (onset - steady)) << "what the first layer has lost still fades";
  needle.toDepth(-1e-6);
  EXPECT_GE(needle.least_work, 0);
}

/// 1 N/m: the hole of the onset, of 12 um without it, ends there.
TEST(PiercedPuncture, AStrongMembraneStopsTheFirstHole) {
  const PunctureConfig config = toughWithMembrane(3e-6, 1, 1);
  const PunctureConfig::Layer& oolemma = config.layers.back();
  const SpringBranch branch;
  PunctureDrive needle(config, 1000, branch.make());
  while (needle.layers() == 0) needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  needle.rest(0.05);
  EXPECT_EQ(needle.layers(), 1);
  ASSERT_TRUE(needle.spring->contact());
  const double depth = needle.cell->insertion().depth, hole = depth - needle.spring->contact()->indentation;
  const double balance = branch.spring * depth - branch.cost + oolemma.stiffness * oolemma.gap;
  EXPECT_NEAR(hole, balance / (branch.spring + oolemma.stiffness), 0.05e-6);
}

TEST(PiercedPuncture, ANeedleThatGoesBackLeavesTheMembrane) {
  const PunctureConfig config = toughWithMembrane(20e-6, 0.02, 0.2e-6);
  PunctureDrive needle(config, 1000, SpringBranch().make());
  needle.toDepth(35e-6);  // stretched by some 6 um
  ASSERT_EQ(needle.layers(), 1);
  needle.toDepth(20e-6);
  for (int i = 0; i < 5; ++i) {
    needle.cell->strike({5e-6, 10e-6});
    needle.rest(0.001);
  }
  EXPECT_EQ(needle.layers(), 1) << "a piezo strikes liquid";
}

TEST(CrackSpeed, IsThatOfTheNeedleAndNotOfNoise) {
  CrackSpeed crack(SpringBranch().make(), {100e-6, 0.5});
  for (int i = 0; i < 1000; ++i) crack.step(i % 2 == 0 ? 10e-9 : -10e-9, 1e-3);
  EXPECT_LT(crack.tougher(), 1.1) << "10 nm of noise";
  for (int i = 0; i < 200; ++i) crack.step(0.1e-6, 1e-3);
  EXPECT_NEAR(crack.tougher(), 2, 0.01);
  crack.reset();
  EXPECT_EQ(crack.tougher(), 1);
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
  const double onset = onsetForce(branch) / branch.spring;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(0.999 * onset);
  needle.toDepth(-1e-6);
  EXPECT_EQ(needle.layers(), 0);
  EXPECT_NEAR(needle.work, 0, 1e-15);
  needle.toDepth(1.001 * onset);
  EXPECT_EQ(needle.layers(), 1);
}

/// The second layer is the cell's own: it fails when the hole comes to it, and no spring stands for it.
TEST(PiercedPuncture, TheCellsNextLayerFailsWhereTheHoleComesToIt) {
  PunctureConfig config = tough();
  config.layers.emplace_back().name = "ooplasm";
  config.layers.back().toughness = 0.25;
  const SpringBranch branch;
  const double border = 20e-6, inner = branch.cost / 4;
  PunctureDrive needle(config, 1000, branch.make(border, inner));
  needle.toDepth(border + 0.95 * branch.cost / branch.spring);
  EXPECT_EQ(needle.layers(), 1);
  EXPECT_NEAR(needle.force.z(), branch.opened + branch.cost, 0.01 * branch.cost);
  double last = needle.force.z(), jump = 0;
  while (needle.layers() == 1) {
    needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
    jump = std::max(jump, std::abs(needle.force.z() - last));
    last = needle.force.z();
  }
  EXPECT_NEAR(needle.cell->insertion().depth, border + branch.cost / branch.spring, 0.1e-6);
  needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  EXPECT_LT(std::max(jump, std::abs(needle.force.z() - last)), 0.45 * (branch.cost - inner)) << "it fades in 2 ms";
  EXPECT_NEAR(needle.rest(0.05), branch.opened + inner, 0.02 * branch.cost);
  needle.toDepth(-1e-6);
  EXPECT_GE(needle.least_work, 0);
  needle.toDepth(30e-6);
  EXPECT_NEAR(needle.rest(0.05), branch.opened + inner, 0.02 * branch.cost) << "again through the hole, and further";
}

PronyTerm relaxing() { return {0.5, 0.2}; }  // s

/// The force of the break has what the whole cell's viscosity adds; what is left of it relaxes while the needle rests.
TEST(PiercedPuncture, BehindTheBreakTheForceOfAViscousCellRelaxes) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make(), {}, relaxing());
  needle.spring->viscous = 0.3;  // of its elastic force
  while (needle.layers() == 0) needle.toDepth(kTop - needle.tip.z() + 0.02e-6);
  const double steady = branch.opened + branch.cost;
  const double early = needle.rest(0.03);
  EXPECT_GT(early, 1.1 * needle.rest(0.2));
  const double dent = needle.cell->insertion().depth - needle.holeLength();
  EXPECT_NEAR(needle.rest(3), branch.opened + branch.spring * dent, 1e-3 * steady);
  needle.toDepth(-1e-6);
  EXPECT_GE(needle.least_work, 0);
}

TEST(PiercedPuncture, OnNoWayDoesTheNeedleGetMoreThanItGave) {
  std::mt19937 random(11);
  const auto draw = [&](double from, double to) { return from + (to - from) * (random() / 4294967296.0); };
  for (int i = 0; i < 60; ++i) {
    SpringBranch branch;
    branch.cost = draw(0.1e-6, 1e-6);
    PunctureConfig config = tough();
    config.resealing_time = i % 2 ? 1 : HUGE_VAL;
    const PronyTerm prony{draw(0, 1), std::exp(draw(std::log(0.01), std::log(3)))};
    PunctureDrive needle(config, 1000, branch.make(), {}, prony);
    if (i % 3 == 0) needle.spring->viscous = draw(0, 1);
    for (int turn = 0; turn < 12; ++turn) {
      if (i % 4 == 0) needle.cell->strike({draw(0, 5e-6), 20e-6});
      needle.toDepth(draw(-2e-6, 42e-6), draw(20e-6, 300e-6));
    }
    needle.toDepth(-2e-6);
    EXPECT_GE(needle.least_work, -1e-3 * branch.cost * 40e-6) << i;
  }
}

/// 50 degrees from the pole, with an upright needle: the branch is the pole's, so that no error is told.
TEST(PiercedPuncture, FarFromThePoleItBreaksWithoutAKickAndTellsNoError) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make(), 0.03);
  needle.moveTo({kRadius * std::sin(50 * M_PI / 180), 0, kTop + 5e-6});
  const double surface = std::sqrt(kRadius * kRadius - needle.tip.x() * needle.tip.x());
  needle.moveTo({needle.tip.x(), 0, surface + 4e-6});
  double last = needle.force.z(), jump = 0;
  while (needle.tip.z() > surface - 35e-6) {
    needle.moveTo({needle.tip.x(), 0, needle.tip.z() - 0.02e-6});
    jump = std::max(jump, std::abs(needle.force.z() - last));
    last = needle.force.z();
  }
  EXPECT_EQ(needle.layers(), 1);
  needle.rest(0.1);
  EXPECT_FALSE(needle.cell->forceError());
  EXPECT_LT(jump, 0.5 * onsetForce(branch)) << "what is lost fades";
  needle.moveTo({needle.tip.x(), 0, kTop + 5e-6});
  EXPECT_GE(needle.least_work, 0);
}

/// 5 um beside it, more than the tip's radius: a hole does not weaken the layer there.
TEST(PiercedPuncture, BesideAnOldHoleTheLayerIsWhole) {
  const SpringBranch branch;
  PunctureDrive needle(tough(), 1000, branch.make());
  needle.toDepth(30e-6);
  needle.toDepth(-5e-6);
  ASSERT_EQ(needle.layers(), 1);
  needle.moveTo({5e-6, 0, kTop + 5e-6});
  needle.largest = needle.work = needle.least_work = 0;
  needle.toDepth(35e-6);
  EXPECT_NEAR(needle.largest, onsetForce(branch), 0.02 * onsetForce(branch));
  EXPECT_EQ(needle.cell->deformedSurface().holes.size(), 2u);
  needle.toDepth(-5e-6);
  EXPECT_GE(needle.least_work, 0);
}

}  // namespace
}  // namespace microinjection
