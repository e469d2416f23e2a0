#include "cell/surrogate/range_border.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

const SurrogateRange kRange{1.0, 20e-6, 45e-6, 5e-6};

TEST(RangeBorder, ChangesNothingInside) {
  for (const Eigen::Vector3d& u : {Eigen::Vector3d(1e-6, -4e-6, -19e-6), Eigen::Vector3d(0, 0, -1e-9)}) {
    const LimitedDisplacement limited(kRange, false, u);
    EXPECT_TRUE(limited.inside);
    EXPECT_EQ(limited.value(), u);
  }
  EXPECT_TRUE(LimitedDisplacement(kRange, true, {0.5e-6, 0, -44e-6}).inside);
  EXPECT_FALSE(LimitedDisplacement(kRange, true, {3e-6, 0, -44e-6}).inside);
  EXPECT_FALSE(LimitedDisplacement(kRange, false, {0, 0, -21e-6}).inside);
  EXPECT_TRUE(LimitedDisplacement(kRange, false, {0, 0, -21e-6}).too_deep);
  EXPECT_FALSE(LimitedDisplacement(kRange, true, {3e-6, 0, -44e-6}).too_deep);
}

TEST(RangeBorder, SaturatesWithinATenth) {
  const LimitedDisplacement far(kRange, false, {30e-6, 40e-6, -100e-6});
  EXPECT_FALSE(far.inside);
  EXPECT_LE(-far.value().z(), 1.1 * 20e-6);
  EXPECT_LE(far.value().head<2>().norm(), 1.1 * 5e-6);
  EXPECT_NEAR(far.value().y() / far.value().x(), 4.0 / 3, 1e-12);  // the same way
}

/// A tip that goes flat, or up, counts as one on the flattest path that was prepared, or a little flatter.
TEST(RangeBorder, DoesNotRise) {
  for (const double rise : {-0.5e-6, 0.0, 3e-6}) {
    const LimitedDisplacement flat(kRange, false, {-4e-6, 0, rise});
    EXPECT_FALSE(flat.inside);
    EXPECT_GT(-flat.value().z(), 0.15 * 4e-6);
    EXPECT_LT(-flat.value().z(), 0.3 * 4e-6);
  }
}

/// First and second derivatives of a quadratic function of the limited displacement, inside, over each border and over
/// both, by central differences.
TEST(RangeBorder, DerivativesAreThoseOfItsValues) {
  const auto function = [](const Eigen::Vector3d& s) {
    Jet jet;
    const Eigen::Matrix3d h = (Eigen::Matrix3d() << 2, 0.3, -0.4, 0.3, 1, 0.2, -0.4, 0.2, 3).finished();
    jet.value = 0.5 * s.dot(h * s);
    jet.gradient = h * s;
    jet.hessian = h;
    return jet;
  };
  const double step = 1e-9;
  for (const bool on_axis : {false, true}) {
    for (const Eigen::Vector3d& u : {Eigen::Vector3d(1e-6, 2e-6, -9e-6), Eigen::Vector3d(1e-6, 2e-6, -21e-6),
                                     Eigen::Vector3d(4e-6, -4e-6, -9e-6), Eigen::Vector3d(4e-6, -4e-6, -22e-6),
                                     Eigen::Vector3d(1e-6, 1.5e-6, -46e-6), Eigen::Vector3d(4e-6, -2e-6, -0.5e-6),
                                     Eigen::Vector3d(-4e-6, 1e-6, 2e-6), Eigen::Vector3d(5e-6, -3e-6, 1e-6)}) {
      const auto at = [&](const Eigen::Vector3d& place) {
        const LimitedDisplacement limited(kRange, on_axis, place);
        return limited.compose(function(limited.value()));
      };
      const Jet jet = at(u);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d move = step * Eigen::Vector3d::Unit(k);
        const Jet plus = at(u + move), minus = at(u - move);
        EXPECT_NEAR((plus.value - minus.value) / (2 * step), jet.gradient[k], 1e-5 * 60e-6);
        EXPECT_LT(((plus.gradient - minus.gradient) / (2 * step) - jet.hessian.col(k)).norm(), 2e-3);
      }
    }
  }
}

}  // namespace
}  // namespace microinjection
