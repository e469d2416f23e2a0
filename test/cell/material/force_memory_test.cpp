#include "cell/material/force_memory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

/// A step relaxes exponentially to the elastic force, whatever the period of the steps.
TEST(ForceMemory, RelaxesAsItsTermsSay) {
  const Eigen::Vector3d force(0, 0, 2);
  for (const double period : {1e-3, 0.05}) {
    ForceMemory memory({{0.5, 0.2}, {0.3, 2}});
    EXPECT_NEAR(memory.step(force, 0).z(), 0.8 * 2, 1e-12);
    double time = 0;
    Eigen::Vector3d more = Eigen::Vector3d::Zero();
    for (; time < 0.5 - 1e-9; time += period) more = memory.step(force, period);
    EXPECT_NEAR(more.z(), 2 * (0.5 * std::exp(-0.5 / 0.2) + 0.3 * std::exp(-0.5 / 2)), 1e-9);
    memory.reset();
    EXPECT_TRUE(memory.step(Eigen::Vector3d::Zero(), 1).isZero(0));
  }
  ForceMemory even({{0.5, 0.2}});  // a ramp of 1 N/s: beta tau (1 - exp(-t / tau))
  double last = 0;
  for (int i = 1; i <= 10; ++i) last = even.step({0, 0, 0.1 * i}, 0.1).z();
  EXPECT_NEAR(last, 0.5 * 0.2 * (1 - std::exp(-1 / 0.2)), 1e-12);
}

TEST(ForceMemory, GoesOnFromAViscousForceThatRelaxes) {
  ForceMemory memory({{0.5, 0.1}, {0.25, 10}});
  const Eigen::Vector3d elastic(0, 0, 1e-6), viscous(0, 0, 0.3e-6);
  memory.start(elastic, viscous);
  EXPECT_TRUE(memory.viscous().isApprox(viscous));
  const double later = memory.step(elastic, 0.2).z();
  EXPECT_NEAR(later, 0.2e-6 * std::exp(-2) + 0.1e-6 * std::exp(-0.02), 1e-12);
  EXPECT_FALSE(ForceMemory({}).isViscous());
}

}  // namespace
}  // namespace microinjection
