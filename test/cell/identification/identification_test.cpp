#include "cell/identification/identification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "base/errors.h"
#include "cell/family/family_cell.h"
#include "cell/family/family_file.h"
#include "cell/identification/family_law.h"
#include "cell/identification/formula_law.h"
#include "cell/identification/identified_scene.h"
#include "made_up_record.h"
#include "shipped_cells.h"

namespace microinjection {
namespace {

std::shared_ptr<FamilyLaw> zona(const std::vector<std::string>& free = {}) {
  const Scene scene = loadScene(kZona);
  return std::make_shared<FamilyLaw>(findFamily(kFamilies, scene), scene, free);
}

TEST(Identify, FindsWhatARecordWasMadeOf) {
  MadeUpRecord record;
  record.drift = 100e-9;
  record.outliers = 0.05;
  const Identification found = identify(record.make(*hertz()), hertz(), {});
  EXPECT_NEAR(found.find("young_modulus")->value, record.modulus, 0.02 * record.modulus);
  EXPECT_NEAR(found.find("contact")->value, record.contact, 0.05e-6);
  EXPECT_NEAR(found.find("offset")->value, record.offset, 1e-9);
  EXPECT_NEAR(found.find("drift")->value, record.drift, 15e-9);
  EXPECT_NEAR(found.noise, record.noise, 0.2 * record.noise);
  EXPECT_TRUE(found.consistent());
}

TEST(Identify, TakesNoDriftThatIsNotThere) {
  EXPECT_EQ(identify(MadeUpRecord().make(*hertz()), hertz(), {}).find("drift"), nullptr);
}

TEST(Identify, IntervalsCover) {
  int modulus = 0, contact = 0;
  constexpr int kTrials = 60;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    MadeUpRecord record;
    record.seed = seed;
    record.noise = 5e-9;
    const Identification found = identify(record.make(*hertz()), hertz(), {});
    const auto covers = [&](const char* name, double truth) {
      const Estimate& estimate = *found.find(name);
      return estimate.low <= truth && truth <= estimate.high;
    };
    modulus += covers("young_modulus", record.modulus);
    contact += covers("contact", record.contact);
  }
  // 95 %: fewer than 52 or more than 60 of 60 have a probability below 1 %.
  EXPECT_GE(modulus, 52);
  EXPECT_GE(contact, 52);
}

TEST(Identify, TheModulusIsAsUncertainAsTheSensorsCalibration) {
  const ForceCurve record = MadeUpRecord().make(*hertz());
  IdentificationConfig config;
  const Identification exact = identify(record, hertz(), config);
  config.calibration_error = 0.1;
  const Identification found = identify(record, hertz(), config);
  const auto modulus = [](const Identification& of) { return *of.find("young_modulus"); };
  EXPECT_EQ(modulus(found).value, modulus(exact).value);
  const double above = std::log(modulus(exact).high / modulus(exact).value);
  EXPECT_NEAR(std::log(modulus(found).high / modulus(found).value), std::hypot(above, std::log(1.1)), 1e-9);
  const double below = std::log(modulus(exact).value / modulus(exact).low);
  EXPECT_NEAR(std::log(modulus(found).value / modulus(found).low), std::hypot(below, std::log(1.1)), 1e-9);
  EXPECT_EQ(found.find("contact")->high, exact.find("contact")->high);
}

TEST(Identify, RefusesARecordWithoutContact) {
  MadeUpRecord record;
  record.contact = 1;
  EXPECT_THROW(identify(record.make(*hertz()), hertz(), {}), ConfigError);
  record.drift = 500e-9;
  EXPECT_THROW(identify(record.make(*hertz()), hertz(), {}), ConfigError);
}

TEST(Identify, AFormulaThatIsNotTheCellsIsInconsistent) {
  MadeUpRecord record;
  FormulaGeometry geometry;
  geometry.half_angle = 1;
  record.modulus = 1e4;
  FormulaGeometry shell;
  shell.shell_thickness = 1e-6;
  shell.cell_radius = 30e-6;
  const Identification found =
      identify(record.make(*makeFormulaLaw("cone", geometry)), makeFormulaLaw("shell", shell), {});
  EXPECT_FALSE(found.consistent());
}

TEST(Identify, FindsTheModulusOfAFamilysCell) {
  MadeUpRecord record;
  record.modulus = 30e3;
  const Identification found = identify(record.make(*zona()), zona(), {});
  EXPECT_NEAR(found.find("young_modulus")->value, record.modulus, 0.03 * record.modulus);
  EXPECT_NEAR(found.find("contact")->value, record.contact, 0.1e-6);
  EXPECT_TRUE(found.consistent());
}

TEST(Identify, SaysWhatCannotBeToldApart) {
  MadeUpRecord record;
  record.modulus = 30e3;
  IdentificationConfig quick;
  quick.intervals = false;
  const Identification found = identify(record.make(*zona()), zona({"core_modulus", "shell_thickness"}), quick);
  EXPECT_FALSE(found.warnings.empty());
}

TEST(FamilyLaw, HasTheForceThatIsServed) {
  const Scene scene = loadScene(kZona);
  std::string reason;
  const auto cell = findFamilyCell(kFamilies, scene, reason);
  ASSERT_TRUE(cell) << reason;
  ForceField::Local local;
  cell->data->field.makeLocal(0, local);
  Eigen::Matrix3d jacobian;
  const double force = local.evaluate({0, 0, -5e-6}, jacobian).z();
  Eigen::VectorXd none;
  const ElasticLaw::Value value = zona()->force(5e-6, none);
  EXPECT_NEAR(scene.cell.material().young_modulus * value.force, force, 1e-6 * force);
  EXPECT_NEAR(scene.cell.material().young_modulus * value.stiffness, -jacobian(2, 2), -1e-6 * jacobian(2, 2));
}

TEST(FamilyLaw, NamesARatioThatTheFamilyHasNot) {
  try {
    zona({"colour"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("family zona has tip_radius, shell_thickness, core_modulus"),
              std::string::npos)
        << error.what();
  }
}

TEST(IdentifiedScene, HasWhatWasFound) {
  MadeUpRecord record;
  record.modulus = 30e3;
  IdentificationConfig quick;
  quick.intervals = false;
  const Identification found = identify(record.make(*zona()), zona({"core_modulus"}), quick);
  const std::string path = testing::TempDir() + "microinjection_identified.yaml";
  std::ofstream(path) << identifiedScene(kZona, "curve.csv", found);
  const Scene scene = loadScene(path);
  const double modulus = found.find("young_modulus")->value;
  EXPECT_NEAR(scene.cell.layers[0].material.young_modulus, modulus, 1e-4 * modulus);
  EXPECT_NEAR(scene.cell.layers[1].material.young_modulus, found.find("core_modulus")->value * modulus, 1e-3 * modulus);
  EXPECT_EQ(scene.needle.tip.radius, loadScene(kZona).needle.tip.radius);
  std::remove(path.c_str());
}

/// 120 samples in contact behind an approach of any length, with and without a drift of the sensor.
TEST(IdentifiedCurve, SparesAShortContactBehindALongApproach) {
  for (const std::size_t far : {3000, 12000, 150000}) {
    for (const double drift : {0.0, 1e-12}) {  // N a sample
      std::mt19937 random(3);
      std::normal_distribution<double> normal;
      ForceCurve curve;
      for (std::size_t i = 0; i < far + 120; ++i) {
        const double sample = static_cast<double>(i), depth = 5e-9 * (sample - static_cast<double>(far));
        curve.time.push_back(1e-3 * sample);
        curve.position.push_back(depth);
        curve.force.push_back(drift * sample + 1e-10 * normal(random) + (depth > 0 ? 20 * std::pow(depth, 1.5) : 0));
      }
      const ForceCurve left = identifiedCurve(curve);
      EXPECT_LE(left.size(), 2000u);
      EXPECT_GE(std::count_if(left.position.begin(), left.position.end(), [](double x) { return x > 0; }), 50)
          << far << " samples before the contact, drift " << drift;
    }
  }
}

/// Real records; see the variable's folder for where they come from.
class RealRecords : public testing::Test {
 protected:
  static Identification identifyFile(const std::string& name) {
    FormulaGeometry geometry;
    geometry.tip_radius = 10e-6;
    geometry.poisson_ratio = 0.5;
    const ForceCurve curve = readForceCurve(std::getenv("MICROINJECTION_FORCE_CURVES") + ("/" + name), {});
    return identify(identifiedCurve(curve), makeFormulaLaw("hertz", geometry), {});
  }
  void SetUp() override {
    if (!std::getenv("MICROINJECTION_FORCE_CURVES")) GTEST_SKIP() << "MICROINJECTION_FORCE_CURVES is not set";
  }
};

TEST_F(RealRecords, HasThePublishedModulus) {
  const Identification found = identifyFile("fmt-jpk-fd_spot3-0192.csv");
  EXPECT_NEAR(found.find("young_modulus")->value, 14742, 0.01 * 14742);
  EXPECT_NEAR(found.find("contact")->value, -18.02931e-6, 0.05e-6);
}

TEST_F(RealRecords, ADriftIsFitted) {
  const Identification found = identifyFile("fmt-jpk-fd_single_tilted-baseline-drift-mitotic_2021-01-29.csv");
  ASSERT_TRUE(found.find("drift"));
  EXPECT_NEAR(found.find("contact")->value, -10.939e-6, 0.05e-6);
}

TEST_F(RealRecords, OneWithoutContactIsRefused) {
  EXPECT_THROW(identifyFile("fmt-jpk-fd_single_bad_2017-01-16_1.csv"), ConfigError);
}

}  // namespace
}  // namespace microinjection
