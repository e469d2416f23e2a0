#include "operation/teleoperation/energy_gate.h"

#include <gtest/gtest.h>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kForce(0, 0, 1);
const Eigen::Vector3d kWith(0, 0, 0.05), kAgainst(0, 0, -0.05);  // m/s

TEST(EnergyGate, LetsAForceThroughToTheLastBitWhileThereIsEnergy) {
  EnergyGate gate{{}};
  EXPECT_EQ(gate.step(kForce, kWith, 1e-2, kStep), kForce);
  EXPECT_EQ(gate.step(kForce, kAgainst, 0, kStep), kForce) << "against the hand it takes energy: always allowed";
  EXPECT_FALSE(gate.acting());
}

TEST(EnergyGate, DoesNoMoreWorkThanThereIsEnergy) {
  EnergyGateConfig config;
  config.fade = 0;
  EnergyGate gate(config);
  const double energy_margin = 2e-5;  // of the 5e-5 J that the whole force would do
  const Eigen::Vector3d force = gate.step(kForce, kWith, energy_margin, kStep);
  EXPECT_NEAR(force.dot(kWith) * kStep, energy_margin, 1e-18);
  EXPECT_TRUE(gate.acting());
  EXPECT_EQ(EnergyGate(config).step(kForce, kWith, 0, kStep), Eigen::Vector3d::Zero().eval());
}

TEST(EnergyGate, FadesAsTheEnergyRunsOut) {
  EnergyGateConfig config;
  EnergyGate gate(config);
  EXPECT_NEAR(gate.step(kForce, kWith, 0.5 * config.fade, kStep).z(), 0.5, 1e-12);
}

TEST(EnergyGate, DampsWhatIsOwedWithinTheDevicesLimit) {
  EnergyGateConfig config;
  EnergyGate gate(config);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const double energy_deficit = 1e-5;
  const double expected = energy_deficit / (0.05 * 0.05 * config.recovery_time) * 0.05;
  EXPECT_NEAR(gate.step(none, kWith, -energy_deficit, kStep).z(), -expected, 1e-12);
  EXPECT_NEAR(gate.step(none, kAgainst, -energy_deficit, kStep).z(), expected, 1e-12);
  EXPECT_NEAR(gate.step(none, kWith, -1, kStep).z(), -config.damping_limit * 0.05, 1e-12);
  // Noise at rest: the force goes to zero with the velocity, it is not divided by it.
  const Eigen::Vector3d creep(0, 0, 1e-5);
  EXPECT_LE(gate.step(none, creep, -1e-9, kStep).norm(), 1e-9 / (4e-6 * config.recovery_time) * 1e-5 + 1e-15);
}

TEST(EnergyGate, WhatWasWithheldComesBackSlowlyAndSlowerEachTime) {
  EnergyGateConfig config;
  EnergyGate gate(config);
  const auto stepsToReturn = [&] {
    gate.step(kForce, kWith, 0, kStep);
    for (int i = 1; i < 5000; ++i) {
      if (gate.step(kForce, Eigen::Vector3d::Zero(), 1, kStep) == kForce) return i;
    }
    return -1;
  };
  EXPECT_NEAR(stepsToReturn(), config.return_time / kStep, 2);
  EXPECT_NEAR(stepsToReturn(), 2 * config.return_time / kStep, 2);
  // Twice more, the first time while it returns.
  gate.step(kForce, kWith, 0, kStep);
  for (int i = 0; i < 10; ++i) gate.step(kForce, Eigen::Vector3d::Zero(), 1, kStep);
  EXPECT_NEAR(stepsToReturn(), 8 * config.return_time / kStep, 4);
  gate.resetReturnTime();
  EXPECT_NEAR(stepsToReturn(), config.return_time / kStep, 2);
}

TEST(EnergyGate, WithoutEnergyAWithheldForceReturnsOnlyAgainstTheHand) {
  EnergyGate gate{{}};
  gate.step(kForce, kWith, 0, kStep);
  for (int i = 0; i < 1000; ++i) gate.step(kForce, Eigen::Vector3d::Zero(), 0, kStep);
  EXPECT_EQ(gate.step(kForce, Eigen::Vector3d::Zero(), 0, kStep), Eigen::Vector3d::Zero().eval());
  for (int i = 0; i < 1000; ++i) gate.step(kForce, kAgainst, 0, kStep);
  EXPECT_EQ(gate.step(kForce, Eigen::Vector3d::Zero(), 0, kStep), kForce);
}

}  // namespace
}  // namespace microinjection
