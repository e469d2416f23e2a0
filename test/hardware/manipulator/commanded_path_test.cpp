#include "hardware/manipulator/commanded_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

constexpr double kSpeed = 100e-6;  // m/s

/// Along x with kSpeed for 1 s, ten set-points a second; then it stands.
CommandedPath walk() {
  CommandedPath path(5);
  for (int i = 0; i <= 10; ++i) path.add(0.1 * i, {kSpeed * 0.1 * i, 0, 0});
  return path;
}

TEST(CommandedPath, ADeviceThatIsLateIsOnThePartOfItsLag) {
  const CommandedPath path = walk();
  for (const double lag : {0.02, 0.1, 0.25}) {
    SCOPED_TRACE(lag);
    for (double now = 0.4; now < 1; now += 0.07) {
      const Eigen::Vector3d place(kSpeed * (now - lag - 0.1), 0, 0);  // set-points come each 0.1 s
      EXPECT_LT(path.nearest(place, now - lag - 0.1, now).distance, 1e-12);
      EXPECT_NEAR(path.nearest(place, 0, now).time, now - lag - 0.1, 1e-9);
      EXPECT_NEAR(path.nearest(place - Eigen::Vector3d(20e-6, 0, 0), now - lag - 0.1, now).distance, 20e-6, 10e-6);
    }
  }
}

TEST(CommandedPath, WhatIsBesideOrPastItIsOff) {
  const CommandedPath path = walk();
  EXPECT_NEAR(path.nearest({50e-6, 3e-6, 0}, 0, 1).distance, 3e-6, 1e-12);
  EXPECT_NEAR(path.nearest({107e-6, 0, 0}, 0.5, 1.5).distance, 7e-6, 1e-12);
  EXPECT_NEAR(path.nearest({50e-6, 0, 0}, 0.9, 1.5).distance, 30e-6, 1e-9)
      << "the part from 0.8 s on was held or passed";
}

TEST(CommandedPath, ASetPointHoldsUntilTheNext) {
  const CommandedPath path = walk();
  EXPECT_LT(path.nearest({100e-6, 0, 0}, 30, 31).distance, 1e-12);
  EXPECT_EQ(path.nearest({100e-6, 0, 0}, 30, 31).time, 31) << "nothing is late at rest";
  EXPECT_NEAR(path.nearest({90e-6, 0, 0}, 30, 31).distance, 10e-6, 1e-12);
}

TEST(CommandedPath, KeepsWhatItMustAndNoMore) {
  CommandedPath path(0.5);
  EXPECT_TRUE(path.empty());
  EXPECT_TRUE(std::isinf(path.nearest({0, 0, 0}, 0, 1).distance));
  for (int i = 0; i <= 100; ++i) path.add(0.1 * i, {kSpeed * 0.1 * i, 0, 0});
  EXPECT_NEAR(path.begin(), 9.4, 1e-9);
  EXPECT_NEAR(path.length(9.65, 10), 3 * kSpeed * 0.1 + kSpeed * 0.1, 1e-9);
  path.clear();
  EXPECT_TRUE(path.empty());
}

}  // namespace
}  // namespace microinjection
