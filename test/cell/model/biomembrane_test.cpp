#include "cell/model/biomembrane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kYoung = 17.9e3, kPoisson = 0.49, kTip = 3e-6, kThickness = 4e-6, kDimple = 20e-6;

/// The same membrane by quadrature: no closed form is used but the balance of forces.
struct Numerical {
  double force, energy, volume;  ///< N, J, m^3

  Numerical(double depth, double tip, double a) {
    constexpr int kSteps = 20000;
    // w' = -s (1/r - r/a^2) with s = F / (2 pi T): the slope for s = 1 gives s from the depth, then everything.
    double shape = 0, area = 0, swept = 0;
    const double step = (a - tip) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const double r = tip + (i + 0.5) * step, slope = 1 / r - r / (a * a);
      shape += step * slope;
      area += step * 2 * M_PI * r * slope * slope / 2;
      swept += step * M_PI * r * r * slope;  // integrated by parts: the tip's share is in it
    }
    const double s = depth / shape, annulus = M_PI * (a * a - tip * tip);
    const double strain = s * s * area / annulus / 2, tension = kYoung * kThickness / (1 - kPoisson) * strain;
    force = s * 2 * M_PI * tension;
    energy = kYoung * kThickness / (1 - kPoisson) * strain * strain * annulus;
    volume = s * swept;
  }
};

TEST(Biomembrane, IsTheEquilibriumFoundByQuadrature) {
  for (const double tip : {0.1e-6, 3e-6, 15e-6, 19e-6}) {
    const Biomembrane membrane(kYoung, kPoisson, tip, {kThickness, kDimple});
    const double expected = Numerical(5e-6, tip, kDimple).force;
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(membrane.force(5e-6), expected, 1e-5 * expected);
  }
}

/// F dw - p dV = dU with p = F / (pi a^2), along the path.
TEST(Biomembrane, NeedleAndPressureDoTheMembranesWork) {
  constexpr double kDepth = 5e-6, kChange = 1e-9;
  const Biomembrane membrane(kYoung, kPoisson, kTip, {kThickness, kDimple});
  const Numerical before(kDepth - kChange, kTip, kDimple), after(kDepth + kChange, kTip, kDimple);
  const double force = membrane.force(kDepth), pressure = force / (M_PI * kDimple * kDimple);
  const double work = force * 2 * kChange - pressure * (after.volume - before.volume);
  EXPECT_NEAR(after.energy - before.energy, work, 1e-5 * work);
  EXPECT_LT(work, 0.9 * force * 2 * kChange);  // pressure matters
}

TEST(Biomembrane, GrowsAsItsFormulaSays) {
  const Biomembrane membrane(kYoung, kPoisson, kTip, {kThickness, kDimple});
  EXPECT_EQ(membrane.force(0), 0);
  EXPECT_NEAR(membrane.force(4e-6) / membrane.force(2e-6), 8, 1e-12);
  EXPECT_NEAR(membrane.stiffness(2e-6), (membrane.force(2.001e-6) - membrane.force(1.999e-6)) / 2e-9,
              1e-6 * membrane.stiffness(2e-6));
  const auto force = [](double young, double tip, double h, double a) {
    return Biomembrane(young, kPoisson, tip, {h, a}).force(1e-6);
  };
  const double base = force(kYoung, kTip, kThickness, kDimple);
  EXPECT_NEAR(force(2 * kYoung, kTip, 3 * kThickness, kDimple), 6 * base, 1e-9 * base);
  EXPECT_NEAR(force(kYoung, 2 * kTip, kThickness, 2 * kDimple), base / 4, 1e-9 * base);  // dimension: E h w^3 / a^2
  double last = 0;
  for (const double tip : {0.01e-6, 0.1e-6, 1e-6, 5e-6, 10e-6, 15e-6, 19e-6}) {  // a blunter tip is harder to push
    EXPECT_GT(force(kYoung, tip, kThickness, kDimple), last);
    last = force(kYoung, tip, kThickness, kDimple);
  }
}

/// zeta -> 1: a narrow ring of width b whose slope falls evenly from edge to edge.
TEST(Biomembrane, NarrowRingsLimit) {
  constexpr double kWidth = 1e-3 * kDimple, kDepth = 1e-8;
  const Biomembrane membrane(kYoung, kPoisson, kDimple - kWidth, {kThickness, kDimple});
  const double slope = 2 * kDepth / kWidth, strain = slope * slope / 12;  // of w'^2 a third, halved twice
  EXPECT_NEAR(membrane.strain(kDepth), strain, 2e-3 * strain);
  // At the tip's edge the slope is the largest: F (1 - c^2/a^2) = 2 pi c T slope.
  const double tension = kYoung * kThickness / (1 - kPoisson) * strain;
  const double force = 2 * M_PI * kDimple * tension * slope / (2 * kWidth / kDimple);
  EXPECT_NEAR(membrane.force(kDepth), force, 5e-3 * force);
}

TEST(Biomembrane, RefusesWhatItCannotDo) {
  EXPECT_THROW(Biomembrane(kYoung, kPoisson, kDimple, {kThickness, kDimple}), ConfigError);
  EXPECT_THROW(Biomembrane(kYoung, kPoisson, kTip, {0, kDimple}), ConfigError);
  EXPECT_THROW(Biomembrane(0, kPoisson, kTip, {kThickness, kDimple}), ConfigError);
  EXPECT_THROW(Biomembrane(kYoung, 0.5, kTip, {kThickness, kDimple}), ConfigError);
}

/// Micrometres are lost in six decimals of a metre.
TEST(Biomembrane, ErrorsTellTheValueThatIsWrong) {
  try {
    Biomembrane(kYoung, kPoisson, 25e-6, {-4e-9, kDimple});
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("thickness = -4e-09 m: must be > 0"), std::string::npos) << text;
    EXPECT_NE(text.find("tip_radius = 2.5e-05 m: must be in (0, dimple_radius)"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace microinjection
