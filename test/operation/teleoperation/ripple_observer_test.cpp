#include "operation/teleoperation/ripple_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

/// What is energy_deficit (J) at most over 4 s, 0.3 mm of ripple at `frequency` (Hz) on a spring of 600 N/m pressed in
/// by 2 mm, late by `late` (s).
double energy_deficit(double frequency, double late, double damping = 0) {
  RippleObserver ripple{{}};
  const auto position = [&](double t) { return -2e-3 + 0.3e-3 * std::sin(2 * M_PI * frequency * t); };
  double worst = 0;
  for (int i = 1; i < 4000; ++i) {
    const double t = i * kStep;
    // The mean over the period, so that holding it takes nothing by itself.
    const double x = 0.5 * (position(t - late) + position(t - kStep - late));
    const double v = (position(t) - position(t - kStep)) / kStep;
    ripple.observe({0, 0, -600 * x - damping * v}, {0, 0, position(t)}, kStep);
    if (i > 1000) worst = std::max(worst, ripple.energy_deficit());
  }
  return worst;
}

TEST(RippleObserver, OwesNothingOfASpringOrADamper) {
  for (const double frequency : {1.0, 3.0, 8.0}) {
    EXPECT_EQ(energy_deficit(frequency, 0), 0) << frequency;
    EXPECT_EQ(energy_deficit(frequency, 0, 3), 0) << frequency;
  }
}

TEST(RippleObserver, FindsAForceThatComesLate) {
  EXPECT_GT(energy_deficit(8, 0.01), 1e-5);
  EXPECT_GT(energy_deficit(3, 0.05), 1e-5);
  EXPECT_EQ(energy_deficit(8, 0.005, 6), 0) << "damping of 6 N s/m makes good 600 N/m late by 5 ms";
}

TEST(RippleObserver, ForgetsWhenItIsReset) {
  RippleObserver ripple{{}};
  for (int i = 1; i < 2000; ++i) {
    const double x = 1e-3 * std::sin(i * 0.05);
    ripple.observe({0, 0, 2 * std::cos(i * 0.05)}, {0, 0, x}, kStep);
  }
  EXPECT_GT(ripple.energy_deficit(), 0);
  ripple.reset();
  EXPECT_EQ(ripple.energy_deficit(), 0);
}

}  // namespace
}  // namespace microinjection
