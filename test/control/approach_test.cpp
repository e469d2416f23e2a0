#include "control/approach.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s
const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kStart(0, 0, 60e-6);

/// Force of a linear cell of 0.1 N/m whose surface is at `surface` (m).
Eigen::Vector3d cellForce(const Eigen::Vector3d& tip, double surface) {
  return std::max(0.0, surface - tip.z()) * 0.1 * kAxis;
}

TEST(Approach, IndentsToItsDepthPastTheTouchAndComesBack) {
  ApproachConfig config;
  Approach approach(config);
  approach.start(kStart);
  Eigen::Vector3d tip = kStart;
  double deepest = tip.z();
  int steps = 0;
  while (!approach.done() && ++steps < 100000) {
    tip = approach.step(kAxis, cellForce(tip, 28e-6), kStep);
    deepest = std::min(deepest, tip.z());
  }
  EXPECT_TRUE(approach.done());
  EXPECT_TRUE(approach.touched());
  // Touch is felt contact_force / stiffness below the surface, to within two steps of the approach.
  const double touch = 28e-6 - config.contact_force / 0.1;
  EXPECT_NEAR(deepest, touch - config.depth, 2 * config.approach_speed * kStep);
  EXPECT_EQ(tip, kStart);
}

TEST(Approach, GivesUpWhereThereIsNoCell) {
  ApproachConfig config;
  Approach approach(config);
  approach.start(kStart);
  double deepest = kStart.z();
  for (int i = 0; i < 20000 && !approach.done(); ++i) {
    deepest = std::min(deepest, approach.step(kAxis, Eigen::Vector3d::Zero(), kStep).z());
  }
  EXPECT_TRUE(approach.done());
  EXPECT_FALSE(approach.touched());
  EXPECT_NEAR(deepest, kStart.z() - config.travel_limit, 1e-9);
}

TEST(Approach, IsNotFooledByForceAcrossThePipette) {
  Approach approach({});
  approach.start(kStart);
  for (int i = 0; i < 100; ++i) approach.step(kAxis, {1e-6, 0, 0}, kStep);
  EXPECT_EQ(approach.phase(), Approach::Phase::kApproach);
}

}  // namespace
}  // namespace microinjection
