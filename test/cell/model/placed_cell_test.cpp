#include "cell/model/placed_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell/model/lock_step.h"
#include "cell/model/spring_cell.h"

namespace microinjection {
namespace {

constexpr double kBallRadius = 30e-6, kSpring = 0.05, kTick = 1e-3;

struct Pressed {
  SpringCell spring{kBallRadius, kSpring};
  PlacedCell cell{spring};
  double time = 0;

  double press(double height) { return cell.step({0, 0, height}, kAxis, time += kTick).force.z(); }
};

TEST(PlacedCell, HigherByALengthItHasTheForceOfThatDepth) {
  Pressed pressed;
  EXPECT_NEAR(pressed.press(kBallRadius - 2e-6), kSpring * 2e-6, 1e-12);
  pressed.cell.moveTo(0.5e-6);
  for (int i = 0; i < 60; ++i) pressed.press(kBallRadius - 2e-6);
  EXPECT_DOUBLE_EQ(pressed.cell.height(), 0.5e-6);
  EXPECT_NEAR(pressed.press(kBallRadius - 2e-6), kSpring * 2.5e-6, 1e-12);
  EXPECT_NEAR(pressed.cell.contact()->indentation, 2.5e-6, 1e-12);
  EXPECT_NEAR(pressed.cell.contact()->contact_point.z(), kBallRadius + 0.5e-6, 1e-12);
}

TEST(PlacedCell, IsTouchedWhereItLies) {
  Pressed pressed;
  pressed.cell.moveTo(1e-6);
  for (int i = 0; i < 200; ++i) pressed.press(kBallRadius + 5e-6);
  EXPECT_EQ(pressed.press(kBallRadius + 1.1e-6), 0);
  EXPECT_FALSE(pressed.cell.contact());
  EXPECT_NEAR(pressed.press(kBallRadius + 0.5e-6), kSpring * 0.5e-6, 1e-12);
}

TEST(PlacedCell, MovesNoFasterThanItsSpeed) {
  Pressed pressed;
  double last = pressed.press(kBallRadius - 2e-6), largest = 0;
  for (int i = 0; i < 400; ++i) {
    pressed.cell.moveTo(i % 2 == 0 ? 5e-6 : -5e-6);  // to and fro
    if (i % 20 == 0) pressed.time += 10;             // after a pause
    const double force = pressed.press(kBallRadius - 2e-6);
    const double pause = i % 20 == 0 ? 10 : 1;
    largest = std::max(largest, std::abs(force - last) / pause);
    last = force;
  }
  EXPECT_LE(largest, kSpring * PlacedCell::kSpeed * kTick * 1.001);
  EXPECT_GT(largest, 0);
}

TEST(PlacedCell, IsDrawnWhereItLies) {
  class Drawn : public SpringCell {
   public:
    using SpringCell::SpringCell;
    DeformedSurface deformedSurface() override {
      DeformedSurface surface;
      surface.vertices = {{1e-6, 2e-6, 3e-6}};
      surface.at_rest = {{1e-6, 2e-6, 4e-6}};
      surface.holes = {{0, 0, kBallRadius}};
      surface.members.resize(1);
      return surface;
    }
  } drawn(kBallRadius, kSpring);
  PlacedCell cell(drawn);
  cell.moveTo(-1e-6);
  for (int i = 0; i <= 200; ++i) cell.step({0, 0, 1}, kAxis, kTick * i);
  const CellModel::DeformedSurface surface = cell.deformedSurface();
  EXPECT_NEAR(surface.vertices[0].z(), 2e-6, 1e-15);
  EXPECT_NEAR(surface.at_rest[0].z(), 3e-6, 1e-15);
  EXPECT_NEAR(surface.holes[0].z(), kBallRadius - 1e-6, 1e-15);
  EXPECT_NEAR(surface.members[0].to.z(), -1e-6, 1e-15);
}

}  // namespace
}  // namespace microinjection
