#include "operation/teleoperation/virtual_coupling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

/// Stiffness (N/m) that a hand pushed in by 1 mm feels of a spring of k (N/m) behind the coupling.
double felt(const VirtualCouplingConfig& config, double k) {
  VirtualCoupling coupling(config);
  coupling.reset(Eigen::Vector3d::Zero());
  double force = 0;
  for (int i = 0; i < 20000; ++i) {
    const double proxy = -1e-3 + coupling.proxyOffset().z();
    force = k * std::max(0.0, -proxy);
    coupling.step({0, 0, force}, 1e-3);
  }
  return force / 1e-3;
}

TEST(VirtualCoupling, IsInSeriesAndNeverStifferThanTheDevice) {
  VirtualCouplingConfig config;
  for (const double k : {20.0, 60.0, 600.0, 2000.0, 8000.0}) {
    EXPECT_NEAR(felt(config, k), 1 / (1 / k + 1 / config.stiffness), 1e-6 * k) << k;
    EXPECT_LT(felt(config, k), config.stiffness) << k;
  }
  EXPECT_GT(felt(config, 60), 0.97 * 60) << "a cell feels as it is";
  config.enabled = false;
  EXPECT_NEAR(felt(config, 8000), 8000, 1e-6);
}

TEST(VirtualCoupling, YieldsWithItsTimeConstantWhateverTheStep) {
  VirtualCouplingConfig config;
  const double tau = config.damping / config.stiffness;
  for (const int steps : {1, 7, 100}) {
    VirtualCoupling coupling(config);
    coupling.reset(Eigen::Vector3d::Zero());
    for (int i = 0; i < steps; ++i) coupling.step({1, 0, 0}, tau / steps);
    EXPECT_NEAR(coupling.proxyOffset().x(), (1 - std::exp(-1)) / config.stiffness, 1e-15) << steps;
  }
}

/// With a device's damping of 1 N s/m at 1 kHz.
TEST(VirtualCoupling, ColgatesConditionForASampledSpring) {
  EXPECT_LE(VirtualCouplingConfig().stiffness, 2 * 1.0 / 1e-3);
}

TEST(VirtualCoupling, DampsWhatComesLateAsStiffAsItIs) {
  const VirtualCouplingConfig config;
  const VirtualCoupling coupling(config);
  EXPECT_EQ(coupling.contactDamping(0), 0) << "nothing in free motion";
  EXPECT_NEAR(coupling.contactDamping(60), 0.48, 1e-12);
  EXPECT_EQ(coupling.contactDamping(1e9), config.damping);
}

}  // namespace
}  // namespace microinjection
