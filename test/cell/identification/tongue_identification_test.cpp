#include "cell/identification/tongue_identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include "base/errors.h"
#include "base/median.h"
#include "cell/model/converged_tongue.h"

namespace microinjection {
namespace {

const std::string kHeld = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_held.yaml";

/// A curve that grows and bends as tongues do, over 0.6 of suction.
TongueShape shape() {
  std::vector<double> suctions, lengths;
  for (int i = 0; i <= 12; ++i) {
    suctions.push_back(0.05 * i);
    lengths.push_back(0.05 + 0.8 * suctions[i] + 0.3 * suctions[i] * suctions[i]);
  }
  return TongueShape(suctions, lengths, 0.004);
}

TongueRecord record(double modulus, double offset, double noise, unsigned seed, int count = 12) {
  const Scene scene = loadScene(kHeld);
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  TongueRecord record;
  for (int i = 1; i <= count; ++i) {
    record.pressure.push_back(-4000.0 * i / count);
    record.length.push_back(offset + scene.radius() * shape().length(4000.0 * i / count / modulus) + error(random));
  }
  return record;
}

TEST(TongueIdentification, FindsTheModulusWhereverTheLengthsBegin) {
  const Scene scene = loadScene(kHeld);
  for (const double modulus : {8e3, 17.9e3, 60e3}) {
    for (const double offset : {0.0, -3e-6}) {
      const Identification found = identifyTongue(record(modulus, offset, 0, 1), scene, shape());
      EXPECT_NEAR(found.find("young_modulus")->value, modulus, 1e-3 * modulus);
      EXPECT_NEAR(found.find("offset")->value, offset, 2e-9);
      EXPECT_TRUE(found.consistent());
      EXPECT_EQ(found.undetermined(), nullptr);
    }
  }
}

TEST(TongueIdentification, TheIntervalHoldsTheTruthNineteenTimesOfTwenty) {
  const Scene scene = loadScene(kHeld);
  int covered = 0, of_offset = 0;
  const int trials = 400;
  for (int i = 0; i < trials; ++i) {
    const Identification found = identifyTongue(record(17.9e3, 1e-6, 0.1e-6, i), scene, shape());
    const Estimate& modulus = *found.find("young_modulus");
    covered += modulus.low <= 17.9e3 && 17.9e3 <= modulus.high;
    const Estimate& offset = *found.find("offset");
    of_offset += offset.low <= 1e-6 && 1e-6 <= offset.high;
  }
  EXPECT_GE(covered, 0.92 * trials);
  EXPECT_GE(of_offset, 0.92 * trials);
}

TEST(TongueIdentification, AnotherCurveIsNotFollowed) {
  TongueRecord other = record(17.9e3, 0, 0, 1);
  for (std::size_t i = 0; i < other.length.size(); ++i) other.length[i] = 1e-6 * std::pow(i / 3.0, 3);
  EXPECT_FALSE(identifyTongue(other, loadScene(kHeld), shape()).consistent());
}

TEST(TongueIdentification, RefusesWhatSaysNothing) {
  const Scene scene = loadScene(kHeld);
  EXPECT_THROW(identifyTongue(record(17.9e3, 0, 0, 1, 3), scene, shape()), ConfigError);
  TongueRecord falling = record(17.9e3, 0, 0, 1);
  for (double& length : falling.length) length = -length;
  EXPECT_THROW(identifyTongue(falling, scene, shape()), ConfigError);
  TongueRecord same = record(17.9e3, 0, 0, 1);
  for (double& pressure : same.pressure) pressure = -100;
  EXPECT_THROW(identifyTongue(same, scene, shape()), ConfigError);
  EXPECT_THROW(TongueShape({0, 1, 2}, {0, 1, 2}, 0), std::invalid_argument);
  EXPECT_THROW(TongueShape({0, 2, 1, 3}, {0, 1, 2, 3}, 0), std::invalid_argument);
}

/// The mechanics of one mesh, against tongues of a converged solution of a cell with another modulus.
TEST(TongueIdentification, FindsTheModulusOfASolvedCell) {
  Scene scene = loadScene(kHeld);
  const TongueShape solved(scene);
  EXPECT_GT(solved.strongest(), 0.2);
  scene.cell.material().young_modulus = 9e3;
  TongueRecord tongues;
  tongues.pressure = {-300, -700, -1200, -2000};
  for (const TonguePoint& point : convergedTongues(scene, tongues.pressure)) {
    ASSERT_TRUE(point.converged);
    tongues.length.push_back(point.held.tongue_length);
  }
  const Identification found = identifyTongue(tongues, loadScene(kHeld), solved);
  EXPECT_NEAR(found.find("young_modulus")->value, 9e3, 0.01 * 9e3);
}

class TongueRecordTest : public testing::Test {
 protected:
  TongueRecord read(const std::string& text, const std::map<std::string, std::string>& columns = {}) const {
    std::ofstream(path_) << text;
    return readTongueRecord(readTextTable(path_), columns);
  }
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = testing::TempDir() + "microinjection_tongue.csv";
};

TEST_F(TongueRecordTest, ReadsUnitsAndSigns) {
  const TongueRecord record = read("suction (kPa),tongue_um\n0.5,3.2\n1,4.1\n,\n2,5.5\n");
  EXPECT_EQ(record.pressure, std::vector<double>({-500, -1000, -2000}));
  ASSERT_EQ(record.length.size(), 3u);
  EXPECT_NEAR(record.length[1], 4.1e-6, 1e-15);
  EXPECT_EQ(record.notes.size(), 2u);
  const TongueRecord named = read("p_Pa,front_nm\n-5,20\n-6,30\n", {{"tongue", "front_nm:nm"}});
  EXPECT_NEAR(named.length[1], 30e-9, 1e-20);
}

TEST_F(TongueRecordTest, NamesWhatIsWrong) {
  const auto told = [&](const std::string& text) {
    try {
      read(text);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(told("pressure_Pa,tongue_um\n-5,1\n5,2\n").find("above and below 0"), std::string::npos);
  EXPECT_NE(told("pressure_Pa,force_N\n-5,1\n-6,2\n").find("has no column of the tongue"), std::string::npos);
  EXPECT_NE(told("pressure_bar,tongue_um\n-5,1\n-6,2\n").find("unit 'bar': must be one of"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
