#include "cell/identification/interpolated_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "cell/identification/identification.h"
#include "made_up_record.h"

namespace microinjection {
namespace {

/// A force (N/Pa) that stiffens the more the larger an exponent is, and has none of it at the touch.
double stiffened(double exponent, double depth) {
  return 3e-6 * std::pow(depth / 1e-6, 1.5) * 1e-6 * std::exp(0.6 * std::tanh(exponent / 10) * depth / 5e-6);
}

TableLaw lawOf(double exponent) {
  std::vector<double> depths, forces;
  for (int k = 1; k <= 16; ++k) {
    depths.push_back(6e-6 * k * k / 256);
    forces.push_back(stiffened(exponent, depths.back()));
  }
  return {"made up", depths, forces, 0};
}

InterpolatedLaw interpolated(double value) {
  std::map<double, TableLaw> laws;
  for (const double exponent : {1, 2, 4, 8, 16, 30}) laws.emplace(exponent, lawOf(exponent));
  return {"exponent", value, laws};
}

TEST(InterpolatedLaw, IsTheKnownLawAtItsValueAndCloseToTheTruthBetween) {
  Eigen::VectorXd by_exponent, none;
  for (const double depth : {1e-8, 1e-6, 5e-6}) {
    const double known = lawOf(8).force(depth, none).force;
    EXPECT_NEAR(interpolated(8).force(depth, by_exponent).force, known, 1e-9 * known) << depth;
    for (const double exponent : {1.4, 3.0, 11.0, 25.0}) {
      const double truth = stiffened(exponent, depth);
      EXPECT_NEAR(interpolated(exponent).force(depth, by_exponent).force, truth, 0.01 * truth)
          << depth << ' ' << exponent;
    }
  }
  EXPECT_EQ(interpolated(8).force(-1e-6, by_exponent).force, 0);
  EXPECT_EQ(by_exponent.size(), 1);
}

TEST(InterpolatedLaw, HasTheDerivativesOfItsForce) {
  constexpr double kDepth = 4e-6, kStep = 1e-4;
  InterpolatedLaw law = interpolated(5);
  Eigen::VectorXd by_exponent, none;
  const ElasticLaw::Value value = law.force(kDepth, by_exponent);
  const double stiffness = (law.force(kDepth * (1 + kStep), none).force - law.force(kDepth * (1 - kStep), none).force) /
                           (2 * kStep * kDepth);
  EXPECT_NEAR(value.stiffness, stiffness, 1e-5 * stiffness);
  const auto at = [&](double exponent) {
    law.set(Eigen::VectorXd::Constant(1, exponent));
    return law.force(kDepth, none).force;
  };
  const double slope = (at(5 * std::exp(kStep)) - at(5 * std::exp(-kStep))) / (2 * kStep);
  EXPECT_NEAR(by_exponent[0], slope, 1e-5 * slope);
}

TEST(InterpolatedLaw, ReachesAsDeepAsBothNeighbours) {
  const TableLaw shallow("made up", {1e-6, 2e-6}, {1e-6, 2e-6}, 0.01);
  InterpolatedLaw law("exponent", 3, {{2, lawOf(2)}, {4, lawOf(4)}, {8, shallow}});
  EXPECT_NEAR(law.deepest(), 6e-6, 1e-12);
  law.set(Eigen::VectorXd::Constant(1, 5));
  EXPECT_NEAR(law.deepest(), 2e-6, 1e-12);
  EXPECT_EQ(law.error(), 0.01);
  const ElasticLaw::Parameter parameter = law.parameters().front();
  EXPECT_NEAR(parameter.low, 2, 1e-9);
  EXPECT_NEAR(parameter.high, 8, 1e-9);
}

TEST(InterpolatedLaw, RefusesWhatCannotBeInterpolated) {
  EXPECT_THROW(InterpolatedLaw("exponent", 3, {{2, lawOf(2)}}), std::invalid_argument);
  EXPECT_THROW(InterpolatedLaw("exponent", 3, {{0, lawOf(2)}, {2, lawOf(2)}}), std::invalid_argument);
}

/// 5 um deep, with a force of 40 nN per kPa there.
Identification identifyRecordOf(double exponent, double depth, unsigned seed, double noise = 0.3e-9) {
  MadeUpRecord record;
  record.contact = 8.1e-6 - depth;
  record.noise = noise;
  record.seed = seed;
  const auto law = std::make_shared<InterpolatedLaw>(interpolated(4));
  return identify(record.make(lawOf(exponent)), law, {});
}

TEST(Identify, FindsAStiffeningBetweenTwoKnownOnes) {
  int covered = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Identification found = identifyRecordOf(5.7, 5e-6, seed);
    const Estimate& exponent = *found.find("exponent");
    EXPECT_TRUE(exponent.bounded());
    EXPECT_NEAR(exponent.value, 5.7, 0.1 * 5.7);
    EXPECT_NEAR(found.find("young_modulus")->value, 2e3, 0.02 * 2e3);
    EXPECT_TRUE(found.consistent());
    covered += exponent.low <= 5.7 && 5.7 <= exponent.high;
  }
  EXPECT_GE(covered, 16);  // of 20 at 95 %: fewer have a probability below 0.3 %
}

TEST(Identify, SaysThatAShallowRecordLeavesTheStiffeningOpen) {
  const Identification found = identifyRecordOf(5.7, 0.5e-6, 1);
  const Estimate& exponent = *found.find("exponent");
  EXPECT_EQ(exponent.open(), "on both sides");
  EXPECT_NEAR(exponent.low, 1, 1e-9);
  EXPECT_NEAR(exponent.high, 30, 1e-9);
  ASSERT_TRUE(found.undetermined());
  EXPECT_EQ(found.undetermined()->name, "exponent");
  EXPECT_NE(std::find(found.warnings.begin(), found.warnings.end(),
                      "exponent is open on both sides: this record does not bound it"),
            found.warnings.end());
}

/// The curvature knows no bounds: its interval would end far beyond what was solved.
TEST(Identify, EndsAnIntervalFromTheCurvatureAtTheBoundsOfTheSearch) {
  MadeUpRecord record;
  record.contact = 7.6e-6;
  record.noise = 0.3e-9;
  IdentificationConfig quick;
  quick.intervals = false;
  const Identification found =
      identify(record.make(lawOf(5.7)), std::make_shared<InterpolatedLaw>(interpolated(4)), quick);
  const Estimate& exponent = *found.find("exponent");
  EXPECT_EQ(exponent.open(), "on both sides");
  EXPECT_NEAR(exponent.high, 30, 1e-9);
}

}  // namespace
}  // namespace microinjection
