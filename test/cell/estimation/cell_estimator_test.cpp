#include "cell/estimation/cell_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "cell/estimation/family_member.h"
#include "cell/family/family_cell.h"
#include "cell/material/force_memory.h"

namespace microinjection {
namespace {

/// A session whose prior is another cell than the one under the needle.
struct Session {
  Scene prior = loadScene(kInjectedCell);
  double factor = 1;                            ///< true modulus over the prior's
  double surface = 0;                           ///< m
  double offset = 0, drift = 0, noise = 10e-9;  ///< N, N/s, N
  double speed = 20e-6, rate = 1000;            ///< m/s, Hz of readings
  unsigned seed = 1;
  CellEstimatorConfig config;
  std::function<double(double time, double force)> sensor = [](double, double force) { return force; };

  /// Indents from 5 um above to `depth` (m), updating every 20 ms.
  CellEstimator indent(double depth) const {
    CellEstimator estimator(prior, memberOf(prior), config);
    indent(depth, estimator);
    return estimator;
  }

  void indent(double depth, CellEstimator& estimator) const {
    Scene truth = prior;
    for (Scene::Layer& layer : truth.cell.layers) layer.material.young_modulus *= factor;
    SurrogateContact cell(truth, memberOf(truth));
    ForceMemory memory(truth.cell.material().viscoelasticity.prony);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise);
    constexpr double kAbove = 5e-6;
    const double period = 1 / rate;
    const int count = static_cast<int>((kAbove + depth) / (speed * period));
    for (int i = 0; i <= count; ++i) {
      const double time = i * period;
      const Eigen::Vector3d tip(0, 0, prior.radius() + surface + kAbove - speed * time);
      const Eigen::Vector3d elastic = cell.step(tip - surface * Eigen::Vector3d::UnitZ()).force;
      const double force = elastic.z() + memory.step(elastic, period).z();
      estimator.add(time, tip, sensor(time, force + offset + drift * time + normal(random)));
      if (i % 20 == 0) estimator.update();
    }
    estimator.update();
  }
};

void expectModulus(const Session& session, const CellEstimate& estimate, double error) {
  const double truth = session.factor * session.prior.cell.material().young_modulus;
  EXPECT_NEAR(estimate.modulus / truth, 1, error) << toText(estimate.verdict) << ": " << estimate.reason;
}

TEST(CellEstimator, FindsACellThatIsThreeTimesStifferAndLies) {
  Session session;
  session.factor = 3;
  session.surface = 0.3e-6;
  session.offset = 40e-9;
  const CellEstimate found = session.indent(8e-6).estimate();
  EXPECT_EQ(found.verdict, EstimateVerdict::kConverged) << found.reason;
  expectModulus(session, found, 0.02);
  EXPECT_NEAR(found.contact, session.surface, 0.05e-6);
  EXPECT_NEAR(found.offset, session.offset, 5e-9);
  EXPECT_NEAR(found.depth, 8e-6, 0.1e-6);
}

TEST(CellEstimator, KnowsOnlyThePriorBeforeContact) {
  Session session;
  session.factor = 3;
  const CellEstimate found = session.indent(-2e-6).estimate();
  EXPECT_EQ(found.verdict, EstimateVerdict::kPrior);
  EXPECT_NEAR(found.modulus / session.prior.cell.material().young_modulus, 1, 0.01);
  EXPECT_GT(found.modulus_high / found.modulus_low, 10);
}

TEST(CellEstimator, WithoutAForceImagesTellTheContactOnly) {
  Session session;
  CellEstimator fresh(session.prior, memberOf(session.prior), session.config);
  const CellEstimate before = fresh.estimate();
  fresh.seeContact(ImageContact::Height{0.8e-6, 0.1e-6});
  const CellEstimate& found = fresh.estimate();
  EXPECT_EQ(found.verdict, EstimateVerdict::kPrior);
  EXPECT_NE(found.reason.find("without a force"), std::string::npos) << found.reason;
  EXPECT_NEAR(found.contact, 0.8e-6, 0.05e-6);  // the prior draws a little
  EXPECT_LT(std::sqrt(found.covariance(1, 1)), 0.1e-6);
  EXPECT_DOUBLE_EQ(found.modulus_high, before.modulus_high);
  fresh.seeContact(std::nullopt);
  EXPECT_EQ(fresh.estimate().contact, 0);
}

TEST(CellEstimator, AnImageOfTheDimpleNarrowsAShortIndentation) {
  Session session;
  session.surface = 0.6e-6;
  const auto width = [](const CellEstimate& found) { return std::log(found.modulus_high / found.modulus_low); };
  constexpr double kDepth = 1.2e-6;  // m, of the tip past where the surface is modelled
  const CellEstimate felt = session.indent(kDepth).estimate();
  CellEstimator estimator(session.prior, memberOf(session.prior), session.config);
  estimator.seeContact(ImageContact::Height{session.surface, 0.1e-6});
  session.indent(kDepth, estimator);
  EXPECT_LT(width(estimator.estimate()), 0.9 * width(felt));
  EXPECT_NEAR(estimator.estimate().contact, session.surface, 0.2e-6);
  expectModulus(session, estimator.estimate(), 0.2);
}

TEST(CellEstimator, LearnsBeforeItConverges) {
  Session session;
  session.factor = 0.5;
  EXPECT_EQ(session.indent(2e-6).estimate().verdict, EstimateVerdict::kLearning);
}

TEST(CellEstimator, IntervalsCover) {
  int covered = 0;
  constexpr int kTrials = 60;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    Session session;
    session.seed = seed;
    session.factor = std::exp(0.03 * (static_cast<int>(seed) - 30));
    const CellEstimate found = session.indent(4e-6).estimate();
    const double truth = session.factor * session.prior.cell.material().young_modulus;
    covered += found.modulus_low <= truth && truth <= found.modulus_high;
  }
  // 95 %: fewer than 52 of 60 have a probability below 1 %.
  EXPECT_GE(covered, 52);
}

TEST(CellEstimator, IsNotMisledByOutliersAndFrozenReadings) {
  Session session;
  session.factor = 2;
  std::mt19937 random(3);
  session.sensor = [&](double, double force) { return random() % 30 == 0 ? force + 1e-6 : force; };
  expectModulus(session, session.indent(8e-6).estimate(), 0.03);
  double held = 0;
  session.sensor = [&](double time, double force) {
    if (time < 0.45 || time > 0.5) held = force;
    return held;
  };
  expectModulus(session, session.indent(8e-6).estimate(), 0.03);
}

TEST(CellEstimator, FindsAStiffCellWithAFastNeedleAndWithASlowSensor) {
  Session session;
  session.factor = 3;
  session.speed = 60e-6;
  expectModulus(session, session.indent(8e-6).estimate(), 0.03);
  session.speed = 20e-6;
  session.rate = 100;
  expectModulus(session, session.indent(8e-6).estimate(), 0.03);
}

TEST(CellEstimator, AFrozenSensorTeachesNothingAndIsNamed) {
  Session session;
  session.factor = 2;
  session.sensor = [](double, double) { return 0.3e-6; };
  CellEstimator estimator = session.indent(8e-6);
  EXPECT_EQ(estimator.estimate().verdict, EstimateVerdict::kPrior);
  EXPECT_NE(estimator.add(10, {0, 0, 0}, 0.3e-6).find("repeats the same reading"), std::string::npos);
}

TEST(CellEstimator, AContradictionStaysUntilTheNextIndentation) {
  Session session;
  // A tip that slips, and then holds again.
  session.sensor = [](double time, double force) {
    return (time < 0.5 ? std::min(force, 0.25e-6) : force) + 1e-9 * std::sin(1e5 * time);
  };
  CellEstimator estimator = session.indent(6e-6);
  if (estimator.estimate().verdict != EstimateVerdict::kInconsistent) session.indent(8e-6, estimator);
  EXPECT_EQ(estimator.estimate().verdict, EstimateVerdict::kInconsistent);
}

TEST(CellEstimator, WhatIsTakenBackIsNotLearned) {
  Session session;
  session.factor = 2;
  session.sensor = [](double time, double force) { return time < 0.55 ? force : 0.2 * force; };  // punctured at 6 um
  CellEstimator estimator = session.indent(8e-6);
  estimator.forgetSince(0.54);
  EXPECT_NE(estimator.estimate().verdict, EstimateVerdict::kInconsistent);
  expectModulus(session, estimator.estimate(), 0.05);
}

TEST(CellEstimator, DoesNotLearnFromASensorThatDrifts) {
  Session session;
  session.factor = 2;
  session.drift = 200e-9;
  const CellEstimate found = session.indent(5e-6).estimate();
  EXPECT_EQ(found.verdict, EstimateVerdict::kPrior);
  EXPECT_NE(found.reason.find("the sensor drifts"), std::string::npos) << found.reason;
  EXPECT_EQ(found.modulus, session.prior.cell.material().young_modulus);
}

TEST(CellEstimator, AForceThatNoCellOfThisModelHasIsInconsistent) {
  Session session;
  // A tip that slips, with what is left of the noise.
  session.sensor = [](double time, double force) { return std::min(force, 0.4e-6) + 1e-9 * std::sin(1e5 * time); };
  const CellEstimate found = session.indent(8e-6).estimate();
  EXPECT_EQ(found.verdict, EstimateVerdict::kInconsistent);
  EXPECT_EQ(found.modulus, session.prior.cell.material().young_modulus);
  EXPECT_FALSE(found.reason.empty());
}

TEST(CellEstimator, KnowsThatACellRelaxes) {
  Session session;
  session.factor = 2;
  session.prior.cell.material().viscoelasticity.prony = {{0.5, 0.1}};
  expectModulus(session, session.indent(8e-6).estimate(), 0.02);
}

TEST(CellEstimator, WhatWasLearnedIsTheNextPrior) {
  Session session;
  session.factor = 2;
  CellEstimator estimator = session.indent(8e-6);
  const double learned = estimator.estimate().modulus;
  estimator.beginNext();
  EXPECT_EQ(estimator.update().verdict, EstimateVerdict::kPrior);
  EXPECT_EQ(estimator.estimate().modulus, learned);
  EXPECT_NEAR(std::sqrt(estimator.estimate().covariance(0, 0)), session.config.next_deviation, 1e-12);
}

TEST(CellEstimator, ANewCellIsToldFromTheOneBefore) {
  Session session;
  session.factor = 3;
  CellEstimator estimator = session.indent(8e-6);
  estimator.beginNext();
  session.factor = 0.8;
  session.indent(8e-6, estimator);
  EXPECT_EQ(estimator.estimate().verdict, EstimateVerdict::kConverged);
  expectModulus(session, estimator.estimate(), 0.02);
}

TEST(CellEstimator, AfterAContradictionThePriorIsTheScenesAgain) {
  Session session;
  session.factor = 2;
  session.sensor = [](double time, double force) { return std::min(force, 0.8e-6) + 1e-9 * std::sin(1e5 * time); };
  CellEstimator estimator = session.indent(8e-6);
  ASSERT_EQ(estimator.estimate().verdict, EstimateVerdict::kInconsistent);
  estimator.beginNext();
  EXPECT_EQ(estimator.estimate().modulus, session.prior.cell.material().young_modulus);
}

TEST(CellEstimator, SurvivesForcesOfAnySize) {
  for (const double size : {1e-30, 1e-3, 1.0, 1e300}) {
    Session session;
    session.sensor = [size](double time, double) { return size * std::sin(100 * time); };
    const CellEstimate found = session.indent(5e-6).estimate();
    EXPECT_TRUE(std::isfinite(found.modulus) && found.covariance.allFinite()) << size;
  }
}

}  // namespace
}  // namespace microinjection
