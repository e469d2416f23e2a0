#include "base/plausible.h"

#include <gtest/gtest.h>

#include <string>

namespace microinjection {
namespace {

std::string refusal(const PlausibleRange& range, double value) {
  ConfigErrors errors;
  range.require("key", value, errors);
  return errors.good() ? "" : errors.messages().front();
}

TEST(PlausibleRange, NamesTheUnitThatIsMeant) {
  EXPECT_EQ(refusal(plausible::kCellDiameter, 56), "key = 56 m: must be 1e-6 .. 5e-3 m; 56 um would be 5.6e-5");
  EXPECT_EQ(refusal(plausible::kTipRadius, 3), "key = 3 m: must be 1e-8 .. 1e-3 m; 3 um would be 3e-6");
  EXPECT_EQ(refusal(plausible::kCellModulus, 0.5), "key = 0.5 Pa: must be 1 .. 1e9 Pa; 0.5 kPa would be 500");
  EXPECT_EQ(refusal(plausible::kForce, 7.5), "key = 7.5 N: must be 1e-13 .. 1 N; 7.5 uN would be 7.5e-6");
  EXPECT_EQ(refusal(plausible::kConeAngle, 35),
            "key = 35 rad: must be above 0 and below 1.571 rad; 35 degrees would be 0.6109");
  EXPECT_EQ(refusal(plausible::kStrain, 15), "key = 15: must be 1e-4 .. 10; 15 % would be 0.15");
}

TEST(PlausibleRange, GuessesNothingWhereNoUnitFits) {
  EXPECT_EQ(refusal(plausible::kCellDiameter, 60e-12), "key = 6e-11 m: must be 1e-6 .. 5e-3 m");
  EXPECT_EQ(refusal(plausible::kCellModulus, 1e10), "key = 1e+10 Pa: must be 1 .. 1e9 Pa");
  EXPECT_EQ(refusal(plausible::kConeAngle, 120), "key = 120 rad: must be above 0 and below 1.571 rad");
  EXPECT_EQ(refusal(plausible::kConeAngle, 0), "key = 0 rad: must be above 0 and below 1.571 rad");
}

TEST(PlausibleRange, HoldsTheSmallestAndTheLargestCellsAndTips) {
  for (const double diameter : {1e-6, 6e-6, 56e-6, 0.7e-3, 1.2e-3, 5e-3})
    EXPECT_EQ(refusal(plausible::kCellDiameter, diameter), "");
  for (const double modulus : {1.0, 100.0, 1e3, 17.9e3, 60e6}) EXPECT_EQ(refusal(plausible::kCellModulus, modulus), "");
  for (const double radius : {10e-9, 50e-9, 0.25e-6, 25e-6}) EXPECT_EQ(refusal(plausible::kTipRadius, radius), "");
}

}  // namespace
}  // namespace microinjection
