#include "cell/identification/combined_modulus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

Identification told(double modulus, double deviation, bool bounded = true) {
  const double wide = std::exp(1.96 * deviation);
  Identification found;
  found.estimates = {{"young_modulus", "Pa", modulus, modulus / wide, modulus * wide, bounded}};
  return found;
}

/// Of the joined ones the error is that of the inverse variances, smaller than either's, and 95 % of the intervals hold
/// the truth.
TEST(CombineModuli, IsBetterThanEither) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 1);
  const double truth = 2e3, first = 0.03, second = 0.05;
  double squares = 0;
  int covered = 0, consistent = 0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    const Identification both = combineModuli(told(truth * std::exp(first * normal(random)), first),
                                              told(truth * std::exp(second * normal(random)), second));
    const Estimate& modulus = *both.find("young_modulus");
    squares += std::pow(std::log(modulus.value / truth), 2);
    covered += modulus.low < truth && truth < modulus.high;
    consistent += both.consistent();
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials), first * second / std::hypot(first, second), 0.001);
  EXPECT_NEAR(covered, 0.95 * kTrials, 0.015 * kTrials);
  EXPECT_GT(consistent, 0.99 * kTrials);
}

TEST(CombineModuli, SaysWhenTheyAreOfDifferentCells) {
  EXPECT_TRUE(combineModuli(told(1000, 0.05), told(1100, 0.05)).consistent());
  EXPECT_FALSE(combineModuli(told(1000, 0.05), told(1400, 0.05)).consistent());
}

TEST(CombineModuli, OneThatIsNotBoundedTellsNothing) {
  const Identification force = combineModuli(told(1000, 0.05), told(3000, 0.05, false));
  EXPECT_EQ(force.find("young_modulus")->value, 1000);
  EXPECT_EQ(force.warnings.size(), 1u);
  EXPECT_EQ(combineModuli(told(1000, 0.05, false), told(3000, 0.05)).find("young_modulus")->value, 3000);
}

}  // namespace
}  // namespace microinjection
