#include "operation/display/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// CIE 1976 lightness L* of an sRGB colour, 0 to 100.
double lightness(const Colour& colour) {
  const double y = 0.2126 * linear(colour.r) + 0.7152 * linear(colour.g) + 0.0722 * linear(colour.b);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

TEST(ColourMap, EndsAreThoseOfViridis) {
  const Colour low = colourOfFraction(0), high = colourOfFraction(1);
  EXPECT_NEAR(low.r, 0.230, 1e-3);
  EXPECT_NEAR(low.b, 0.546, 1e-3);
  EXPECT_NEAR(high.r, 0.993, 1e-3);
  EXPECT_NEAR(high.g, 0.906, 1e-3);
}

TEST(ColourMap, ClampsOutsideTheRange) {
  EXPECT_EQ(colourOfFraction(-1).g, colourOfFraction(0).g);
  EXPECT_EQ(colourOfFraction(7).g, colourOfFraction(1).g);
}

TEST(ColourMap, LightnessRisesEvenly) {
  constexpr int kSteps = 50;
  const double mean = (lightness(colourOfFraction(1)) - lightness(colourOfFraction(0))) / kSteps;
  ASSERT_GT(mean * kSteps, 45);
  for (int i = 0; i < kSteps; ++i) {
    const double step =
        lightness(colourOfFraction((i + 1.0) / kSteps)) - lightness(colourOfFraction(static_cast<double>(i) / kSteps));
    EXPECT_NEAR(step, mean, 0.35 * mean) << "at step " << i;
  }
}

TEST(NiceCeiling, IsTheNextShortFigure) {
  EXPECT_DOUBLE_EQ(niceCeiling(1e-6), 1e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(1.01e-6), 1.2e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(12e-6), 12e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(12.000001e-6), 12e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(12.5e-6), 16e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(81e-6), 100e-6);
  EXPECT_DOUBLE_EQ(niceCeiling(0), 1);
  EXPECT_DOUBLE_EQ(niceCeiling(-3), 1);
}

}  // namespace
}  // namespace microinjection
