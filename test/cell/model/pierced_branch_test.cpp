#include "cell/model/pierced_branch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "cell/model/spring_branch.h"

namespace microinjection {
namespace {

constexpr double kOpenedHole = SpringBranch().opened, kBottom = SpringBranch().spring, kCrack = SpringBranch().cost;

std::vector<PiercedBranch::Knot> springPath(double length) { return SpringBranch().path(length); }

PiercedBranch springBranch(double cost = kCrack, double barrier = 0) {
  SpringBranch made;
  made.cost = cost;
  made.barrier = barrier;
  return made.make();
}

/// Where (e + c) d - c^2 / (2 k) + barrier is k/2 d^2.
double closedOnset(double cost, double barrier) {
  const double sum = kOpenedHole + cost;
  return (sum + std::sqrt(sum * sum - cost * cost + 2 * kBottom * barrier)) / kBottom;
}

TEST(PiercedBranch, FailsWhereTheHoleHasLessEnergyWithItsCost) {
  for (const double barrier : {0.0, 3e-12}) {
    const PiercedBranch tough = springBranch(kCrack, barrier);
    ASSERT_TRUE(tough.onset());
    const double depth = closedOnset(kCrack, barrier);
    EXPECT_NEAR(tough.onset()->depth, depth, 1e-3 * depth);
    EXPECT_NEAR(tough.onset()->force, kBottom * depth, 1e-3 * kBottom * depth);
    EXPECT_NEAR(tough.onset()->length, depth - kCrack / kBottom, 1e-3 * depth);
    EXPECT_NEAR(tough.onset()->pierced_force, kOpenedHole + kCrack, 1e-3 * kCrack)
        << "the force falls to the steady one";
    EXPECT_GT(tough.onset()->force, 1.2 * tough.onset()->pierced_force);
  }
  EXPECT_FALSE(springBranch(20e-6).onset()) << "the whole cell's path ends before";
}

/// Of a cell that stiffens, a path that is continued with a constant stiffness has too little energy.
TEST(PiercedBranch, NoCrackBeginsBeyondTheEndOfAPath) {
  constexpr double kCubic = 1.6e7, kStiffCrack = 1.2e-6;  // N/m^3, N: not pierced in 40 um
  const auto path = [&](double deepest) {
    std::vector<PiercedBranch::Knot> knots;
    for (double beyond = 0; beyond <= deepest; beyond += 1e-6)
      knots.push_back({beyond, kCubic * std::pow(beyond, 3), kCubic / 4 * std::pow(beyond, 4)});
    return knots;
  };
  for (const double deepest : {10e-6, 40e-6}) {
    const PiercedBranch branch(path(40e-6), {{1e-6, path(deepest)}, {3e-6, path(deepest)}}, {{{0, kStiffCrack}}});
    const double excess = branch.at(40e-6, 3e-6).energy + kStiffCrack * 3e-6 - branch.whole(40e-6).energy;
    EXPECT_EQ(excess < 0, deepest < 40e-6) << "the test would not notice";
    EXPECT_FALSE(branch.onset()) << deepest;
  }
}

/// Continued to the pole, the force with which its path begins would give the shortest hole a negative energy there.
TEST(PiercedBranch, BeginsOnlyWhereTheNeedleIsKnownToStayInTheHole) {
  SpringBranch made;
  std::vector<PiercedBranch::Hole> holes;
  for (const double length : {1e-6, 3e-6, 7e-6, 15e-6, 30e-6}) holes.push_back({length, made.path(length)});
  auto& knots = holes.front().knots;
  knots.erase(knots.begin(), knots.begin() + 12);
  const PiercedBranch late(made.path(0), holes, {{{0, kCrack}}});
  EXPECT_LT(late.at(0, 1e-6).energy + kCrack * 1e-6, 0) << "the test would not notice";
  ASSERT_TRUE(late.onset());
  const double depth = closedOnset(kCrack, 0);
  EXPECT_NEAR(late.onset()->depth, depth, 1e-3 * depth);
}

TEST(PiercedBranch, ForceAndReleaseAreSlopesOfTheEnergy) {
  const PiercedBranch tough = springBranch();
  constexpr double kStep = 1e-9;
  for (const double length : {1.5e-6, 3.2e-6, 6.9e-6, 20e-6}) {
    for (const double depth : {length - 3.3e-6, length + 0.4e-6, length + 11e-6}) {
      const PiercedBranch::State here = tough.at(depth, length);
      const double by_depth =
          (tough.at(depth + kStep, length).energy - tough.at(depth - kStep, length).energy) / (2 * kStep);
      const double by_length =
          (tough.at(depth, length + kStep).energy - tough.at(depth, length - kStep).energy) / (2 * kStep);
      EXPECT_NEAR(here.force, by_depth, 1e-5 * kCrack);
      EXPECT_NEAR(here.release, -by_length, 1e-5 * kCrack);
      EXPECT_NEAR(here.force, kOpenedHole + kBottom * std::max(depth - length, 0.0), 1e-9 * kCrack);
    }
  }
}

/// Holes whose bottoms are the stiffer the longer they are.
TEST(PiercedBranch, HolesBeyondTheSolvedLengthsHaveForcesThatAreSlopes) {
  std::vector<PiercedBranch::Hole> holes;
  for (const double length : {1e-6, 3e-6, 7e-6, 15e-6}) {
    SpringBranch made;
    made.spring *= 1 + length / 20e-6;
    holes.push_back({length, made.path(length)});
  }
  const PiercedBranch tough(springPath(0), holes, {{{0, kCrack}}});
  constexpr double kStep = 1e-9;
  for (const double length : {0.6e-6, 2e-6, 11e-6, 19e-6}) {
    const double depth = length + 7.3e-6;
    const PiercedBranch::State here = tough.at(depth, length);
    const auto energy = [&](double d, double l) { return tough.at(d, l).energy; };
    EXPECT_NEAR(here.force, (energy(depth + kStep, length) - energy(depth - kStep, length)) / (2 * kStep),
                1e-5 * kCrack);
    EXPECT_NEAR(here.release, (energy(depth, length - kStep) - energy(depth, length + kStep)) / (2 * kStep),
                1e-5 * kCrack);
  }
}

TEST(PiercedBranch, TheHoleGrowsWithTheNeedleAndNeverShrinks) {
  const PiercedBranch tough = springBranch();
  double length = tough.onset()->length;
  const double start = tough.onset()->depth;
  for (double depth = start; depth < start + 20e-6; depth += 0.5e-6) {
    length = tough.grown(depth, length);
    EXPECT_NEAR(length, depth - kCrack / kBottom, 1e-9);
    EXPECT_NEAR(tough.at(depth, length).force, kOpenedHole + kCrack, 1e-3 * kCrack);
  }
  EXPECT_EQ(tough.grown(5e-6, length), length);
  EXPECT_NEAR(tough.at(length - 20e-6, length).force, kOpenedHole, 1e-9 * kCrack) << "below the first knot";
}

TEST(PiercedBranch, EachLayerOfTheCellHasItsOwnCost) {
  const double border = 25e-6, inner = kCrack / 4;
  const PiercedBranch branch = SpringBranch().make(border, inner);
  EXPECT_EQ(branch.costAt(border), kCrack);
  EXPECT_EQ(branch.costAt(1.01 * border), inner);
  EXPECT_NEAR(branch.costUntil(border + 4e-6), kCrack * border + inner * 4e-6, 1e-9 * kCrack * border);
  double length = branch.onset()->length;
  ASSERT_LT(length, border);
  for (double depth = branch.onset()->depth; depth < 45e-6; depth += 0.2e-6) {
    length = branch.grown(depth, length);
    const double cost = length < border ? kCrack : inner;
    EXPECT_NEAR(length, depth - cost / kBottom, length < border ? 1e-9 : 0.1e-6) << depth;
  }
  EXPECT_GT(length, 40e-6);
  EXPECT_NEAR(branch.tougher(2).costUntil(30e-6), 2 * branch.costUntil(30e-6), 1e-9 * branch.costUntil(30e-6));
}

TEST(PiercedBranch, AStrengthThatIsExceededDecidesInPlaceOfTheEnergy) {
  const SpringBranch made;
  for (const double share : {0.9, 1.2}) {
    PiercedBranch::Crack crack{{{0, kCrack}}};
    crack.gives_way = share * closedOnset(kCrack, 0);
    const PiercedBranch branch(made.path(0), made.make().holes(), crack);
    ASSERT_TRUE(branch.onset());
    EXPECT_EQ(branch.onset()->depth, crack.gives_way);
    EXPECT_NEAR(branch.onset()->force, kBottom * crack.gives_way, 1e-3 * kCrack);
    EXPECT_NEAR(branch.onset()->pierced_force, kOpenedHole + kCrack, 1e-3 * kCrack);
  }
}

TEST(PiercedBranch, RefusesPathsThatDoNotRise) {
  const std::vector<PiercedBranch::Knot> twice = {{0, 0, 0}, {0, 1e-6, 0}};
  const PiercedBranch::Crack crack{{{0, kCrack}}};
  const std::vector<PiercedBranch::Hole> holes = {{1e-6, springPath(1e-6)}, {2e-6, springPath(2e-6)}};
  EXPECT_THROW(PiercedBranch(twice, holes, crack), std::invalid_argument);
  EXPECT_THROW(PiercedBranch(springPath(0), {holes[1], holes[0]}, crack), std::invalid_argument);
  EXPECT_THROW(PiercedBranch(springPath(0), {holes[0]}, crack), std::invalid_argument);
  EXPECT_THROW(PiercedBranch(springPath(0), holes, {{{1e-6, kCrack}}}), std::invalid_argument);
  EXPECT_THROW(PiercedBranch(springPath(0), holes, {{{0, kCrack}, {0, kCrack}}}), std::invalid_argument);
  EXPECT_THROW(springBranch(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
