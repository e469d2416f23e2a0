#include "operation/teleoperation/tremor_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

TEST(TremorFilter, IsOffByDefaultToTheLastBit) {
  TremorFilter filter{{}};
  filter.reset({0, 0, 0});
  EXPECT_EQ(filter.step({0.1, 0.2, 0.3}, kStep), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(filter.delay(), 0);
}

TEST(TremorFilter, SlowMotionIsLateByTheStatedDelay) {
  TremorFilterConfig config;
  config.cutoff = 6;
  TremorFilter filter(config);
  EXPECT_NEAR(filter.delay(), 0.0375, 1e-4);
  const double speed = 0.02;
  double lag = 0;
  for (int i = 0; i < 2000; ++i) {
    const double u = speed * i * kStep;
    lag = u - filter.step({u, 0, 0}, kStep).x();
  }
  EXPECT_NEAR(lag / speed, filter.delay(), 1e-9);
}

TEST(TremorFilter, AttenuatesAsAButterworthOfSecondOrder) {
  TremorFilterConfig config;
  config.cutoff = 6;
  for (const double frequency : {1.0, 6.0, 10.0, 30.0}) {
    TremorFilter filter(config);
    double peak = 0;
    for (int i = 0; i < 6000; ++i) {
      const double out = filter.step({0, std::sin(2 * M_PI * frequency * i * kStep), 0}, kStep).y();
      if (i > 4000) peak = std::max(peak, std::abs(out));
    }
    EXPECT_NEAR(peak, 1 / std::sqrt(1 + std::pow(frequency / config.cutoff, 4)), 0.004) << frequency;
  }
}

TEST(TremorFilter, BeginsAtRestWhereItIsPut) {
  TremorFilterConfig config;
  config.cutoff = 6;
  TremorFilter filter(config);
  filter.reset({1, 2, 3});
  EXPECT_LT((filter.step({1, 2, 3}, kStep) - Eigen::Vector3d(1, 2, 3)).norm(), 1e-15);
}

}  // namespace
}  // namespace microinjection
