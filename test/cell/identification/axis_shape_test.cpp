#include "cell/identification/axis_shape.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

double softening(double depth) { return 2e-6 * std::pow(depth, 1.5) * (1 - 1e4 * depth); }

TEST(AxisShape, InterpolatesForceAndStiffness) {
  const AxisShape shape(softening, 20e-6);
  constexpr double kStep = 1e-10;
  for (const double depth : {0.1e-6, 1e-6, 5.3e-6, 19e-6}) {
    const double force = softening(depth);
    EXPECT_NEAR(shape.at(depth).force, force, 2e-4 * force) << depth;
    const double stiffness = (softening(depth + kStep) - softening(depth - kStep)) / (2 * kStep);
    EXPECT_NEAR(shape.at(depth).stiffness, stiffness, 5e-3 * stiffness) << depth;
  }
}

TEST(AxisShape, HasNoForceAboveTheContactAndGoesOnStraightBelowItsEnd) {
  const AxisShape shape(softening, 20e-6);
  EXPECT_EQ(shape.at(-1e-6).force, 0);
  EXPECT_EQ(shape.at(0).stiffness, 0);
  const ElasticLaw::Value end = shape.at(20e-6);
  EXPECT_NEAR(shape.at(22e-6).force, end.force + 2e-6 * end.stiffness, 1e-9 * end.force);
}

}  // namespace
}  // namespace microinjection
