#include "cell/model/shaft_resistance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cell/model/fading_force.h"
#include "cell/model/lock_step.h"

namespace microinjection {
namespace {

/// One there and back over `amplitude` m with `length` m in the cytoplasm: the work that it takes, J.
double loop(ShaftResistance& shaft, double amplitude, double length, int steps = 4000) {
  double work = 0, last = 0, force = 0;
  for (int i = 1; i <= steps; ++i) {
    const double z = amplitude * (1 - std::abs(2.0 * i / steps - 1));
    const double next = shaft.step({0, 0, z}, kAxis, length, kStep).z();
    work -= 0.5 * (force + next) * (z - last);
    force = next;
    last = z;
  }
  return work;
}

/// Stuck within F/k the spring gives all back; beyond, a settled loop takes 2 F (2 A - 2 F/k) with the travel 2 A.
TEST(ShaftResistance, ALoopTakesTheWorkOfSliding) {
  const double friction = 0.1e-6, adhesion = 5e-3, length = 20e-6, stiffness = 0.2,
               bound = friction + adhesion * length;
  PunctureConfig::Shaft config{friction, adhesion, stiffness, 0, 0};
  ShaftResistance shaft(config);
  shaft.enter({0, 0, 0});
  EXPECT_NEAR(loop(shaft, 0.9 * bound / stiffness, length), 0, 1e-22);
  const double travel = 10e-6;
  loop(shaft, travel, length);
  const double expected = 2 * bound * (travel - 2 * bound / stiffness);
  EXPECT_NEAR(loop(shaft, travel, length), expected, 1e-3 * expected);
  EXPECT_NEAR(loop(shaft, travel, length, 40000), expected, 1e-3 * expected);  // whatever the rate
}

TEST(ShaftResistance, HoldsWithoutDriftAndPullsOnTheWayOut) {
  ShaftResistance shaft({0.1e-6, 5e-3, 0.3, 0, 0});
  shaft.enter({0, 0, 0});
  EXPECT_DOUBLE_EQ(shaft.step({0, 0, -10e-6}, kAxis, 20e-6, kStep).z(), 0.2e-6);
  const Eigen::Vector3d held = shaft.step({0, 0, -10e-6}, kAxis, 20e-6, kStep);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(shaft.step({0, 0, -10e-6}, kAxis, 20e-6, kStep), held);
  EXPECT_DOUBLE_EQ(shaft.step({0, 0, -10e-6}, kAxis, 0, kStep).z(), 0.1e-6);  // less of it in the cytoplasm
  EXPECT_DOUBLE_EQ(shaft.step({0, 0, -5e-6}, kAxis, 20e-6, kStep).z(), -0.2e-6);
  EXPECT_DOUBLE_EQ(shaft.step({0, 0, -4e-6}, kAxis, -1e-6, kStep).z(), -0.1e-6);
}

TEST(ShaftResistance, DragIsThatOfLengthAndVelocity) {
  ShaftResistance shaft({0, 0, 0.3, 4, 0});
  shaft.enter({0, 0, 0});
  const Eigen::Vector3d move(1e-8, -2e-8, -5e-8);
  const Eigen::Vector3d expected = -4 * 20e-6 / kStep * move;
  EXPECT_TRUE(shaft.step(move, kAxis, 20e-6, kStep).isApprox(expected, 1e-12));
  EXPECT_TRUE(shaft.step(2 * move, kAxis, 20e-6, 0).isZero(0));  // a clock that stands
  EXPECT_TRUE(shaft.step(3 * move, kAxis, 0, kStep).isZero(0));
}

TEST(ShaftResistance, TheRimHoldsAcrossTheAxisOnly) {
  ShaftResistance shaft({0, 0, 0.3, 0, 0.02});
  shaft.enter({1e-6, 0, 0});
  const Eigen::Vector3d tilted(0.6, 0, 0.8);
  EXPECT_TRUE(shaft.step(Eigen::Vector3d(1e-6, 0, 0) - 8e-6 * tilted, tilted, 0, kStep).isZero(1e-18));
  EXPECT_TRUE(shaft.step({4e-6, 0, -9e-6}, kAxis, 0, kStep).isApprox(Eigen::Vector3d(-0.02 * 3e-6, 0, 0), 1e-12));
}

TEST(FadingForce, FallsWithTimeAndWay) {
  FadingForce fading(2e-3);
  EXPECT_TRUE(fading.at({0, 0, 0}, 0).isZero(0));
  const Eigen::Vector3d force(0, 3e-6, 4e-6), tip(0, 0, 1e-6), along(0, 0.6, 0.8);
  fading.start(force, tip, 5e-12, 1);  // 5 uN over 2 um
  EXPECT_EQ(fading.at(tip, 1), force);
  EXPECT_TRUE(fading.at(tip - 1e-6 * along, 1.002).isApprox(std::exp(-1) * force, 1e-9));
  EXPECT_TRUE(fading.at(tip + 0.5e-6 * along, 1).isApprox(0.75 * force, 1e-9));
  EXPECT_TRUE(fading.at(tip + 2.001e-6 * along, 1).isZero(0));
  EXPECT_TRUE(fading.at(tip, 1.043).isZero(0));
  fading.start(force, tip, -1, 2);  // nothing to give back
  EXPECT_TRUE(fading.at(tip + 1e-12 * along, 2).isZero(0));
}

}  // namespace
}  // namespace microinjection
