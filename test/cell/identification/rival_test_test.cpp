#include "cell/identification/rival_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cell/family/family_cell.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"
#include "made_up_record.h"
#include "shipped_cells.h"

namespace microinjection {
namespace {

constexpr double kModulus = 30e3;  // Pa

/// 500 samples from 4 um above the surface to `depth` (m) below it, with a noise of `noise` (N).
AxisSamples samplesOf(const AxisShape& shape, double depth, double noise, unsigned seed) {
  constexpr Eigen::Index kCount = 500;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  AxisSamples samples;
  samples.travel = Eigen::VectorXd::LinSpaced(kCount, -4e-6, depth);
  samples.time = (samples.travel.array() + 4e-6) / 20e-6;
  samples.deviation = Eigen::VectorXd::Constant(kCount, noise);
  samples.force.resize(kCount);
  for (Eigen::Index i = 0; i < kCount; ++i) {
    samples.force[i] = kModulus * shape.at(samples.travel[i]).force + 20e-9 + noise * normal(random);
  }
  return samples;
}

AxisShape shapeOf(const ElasticLaw& law) {
  return AxisShape(
      [&](double depth) {
        Eigen::VectorXd none;
        return law.force(depth, none).force;
      },
      law.deepest());
}

class RivalTest : public testing::Test {
 protected:
  static Scene layered() { return loadScene(kZona); }
  static Scene homogeneous() {
    Scene scene = layered();
    scene.cell.layers.resize(1);
    return scene;
  }
  static FamilyLaw lawOf(const Scene& scene) { return {findFamily(kFamilies, scene), scene, {}}; }

  static RivalComparison compare(const Scene& truth, const Scene& estimated, double depth, double noise, unsigned seed,
                                 ShapeFitConfig config = {}) {
    static const auto families = loadFamilies(kFamilies);
    const FamilyLaw law = lawOf(estimated);
    ShapeFit start;
    start.modulus = kModulus;
    start.contact = 0.3e-6;
    return compareWithRivals({shapeOf(law), law.error()}, rivalCells(families, estimated),
                             samplesOf(shapeOf(lawOf(truth)), depth, noise, seed), config, start);
  }
};

TEST_F(RivalTest, AFitFindsWhatTheSamplesWereMadeOf) {
  const AxisShape shape = shapeOf(lawOf(layered()));
  AxisSamples samples = samplesOf(shape, 6e-6, 1e-12, 1);
  samples.force.array() += 50e-9 * samples.time.array();
  samples.force[120] += 1e-6;  // an outlier
  ShapeFitConfig config;
  config.drift = true;
  ShapeFit start;
  start.modulus = 2 * kModulus;
  start.contact = -0.8e-6;
  samples.deviation.setConstant(1e-10);
  const ShapeFit fit = fitShape(shape, samples, config, start, 40);
  EXPECT_NEAR(fit.modulus, kModulus, 1e-3 * kModulus);
  EXPECT_NEAR(fit.contact, 0, 1e-9);
  EXPECT_NEAR(fit.offset, 20e-9, 1e-10);
  EXPECT_NEAR(fit.drift, 50e-9, 1e-9);
}

TEST_F(RivalTest, ALayeredCellContradictsAHomogeneousOne) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const RivalComparison found = compare(layered(), homogeneous(), 12e-6, 2e-9, seed);
    EXPECT_TRUE(found.contradicts()) << found.advantage;
    EXPECT_EQ(found.best.rfind("zona", 0), 0U) << found.best;
  }
}

TEST_F(RivalTest, TheRightCellIsNotContradicted) {
  for (const double noise : {10e-9, 1e-9}) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      EXPECT_FALSE(compare(homogeneous(), homogeneous(), 10e-6, noise, seed).contradicts()) << noise << ' ' << seed;
      EXPECT_FALSE(compare(layered(), layered(), 10e-6, noise, seed).contradicts()) << noise << ' ' << seed;
    }
  }
}

TEST_F(RivalTest, WhereTheForceDoesNotTellTheModuliOfBothAreGiven) {
  const RivalComparison found = compare(layered(), homogeneous(), 3e-6, 30e-9, 1);
  EXPECT_FALSE(found.contradicts()) << found.advantage;
  EXPECT_FALSE(found.layersAreKnown());
  EXPECT_LT(1.25 * found.own.modulus, kModulus);  // the homogeneous one alone would be wrong
  EXPECT_LE(found.modulus_low, kModulus);
  EXPECT_GE(found.modulus_high, kModulus);
}

TEST_F(RivalTest, AKnownContactTellsThemApartEarlier) {
  ShapeFitConfig known;
  known.contact_deviation = 0.05e-6;
  double without = 0, with = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    without += compare(layered(), homogeneous(), 6e-6, 10e-9, seed).advantage;
    with += compare(layered(), homogeneous(), 6e-6, 10e-9, seed, known).advantage;
  }
  EXPECT_GT(with, without + 5 * 4);
}

TEST_F(RivalTest, IdentifySaysThatItIsAnotherCell) {
  MadeUpRecord record;
  record.modulus = kModulus;
  record.noise = 0.5e-9;
  const auto law = std::make_shared<FamilyLaw>(lawOf(homogeneous()));
  IdentificationConfig config;
  config.intervals = false;
  config.rivals = std::make_shared<const std::vector<RivalCell>>(rivalCells(loadFamilies(kFamilies), homogeneous()));
  const ForceCurve curve = record.make(lawOf(layered()));
  EXPECT_FALSE(identify(curve, law, config).consistent());
  config.rivals = nullptr;
  EXPECT_TRUE(identify(curve, law, config).consistent());  // its own residuals do not show it
}

TEST_F(RivalTest, TheAxisForceIsThatOfTheFamilysCell) {
  for (const RivalCell& rival : rivalCells({findFamily(kFamilies, homogeneous())}, homogeneous())) {
    Eigen::VectorXd none;
    const double force = lawOf(homogeneous()).force(7e-6, none).force;
    EXPECT_NEAR(rival.shape.at(7e-6).force, force, 0.02 * force) << rival.description;
  }
}

}  // namespace
}  // namespace microinjection
