#include "operation/record/training_log.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

class TrainingLogTest : public testing::Test {
 protected:
  TrainingLogTest() {
    std::filesystem::remove_all(folder_);
    config_.trainee = "ada";
    config_.history = folder_ + "/all/history.csv";
    config_.task.volume = 5e-15;
    config_.punctures = "felt";
  }
  ~TrainingLogTest() override { std::filesystem::remove_all(folder_); }

  static SessionTable::Row row(double time, const std::string& state, double depth, double force) {
    SessionTable::Row row;
    row.time = time;
    row.injection = state;
    row.needle = SessionTable::Pose{{0, 0, 28e-6 - depth}, Eigen::Vector3d::UnitZ()};
    row.predicted = Eigen::Vector3d(0, 0, force);
    row.measured = SessionTable::Measured{2 * force, 0};
    row.depth = depth;
    row.volume = 0;
    return row;
  }

  /// Down to 10 um and out again, in 8 s.
  static TrainingLog& indented(TrainingLog& log) {
    log.add(row(0, "", -10e-6, 0));
    log.add(row(1, "approach", -10e-6, 0));
    log.add(row(5, "indent", 10e-6, 1e-6));
    SessionTable::Row through = row(6, "punctured", 11e-6, 0.1e-6);
    through.punctures = 1;
    log.add(through);
    through.time = 7;
    through.injection = "inject";
    through.volume = 5e-15;
    log.add(through);
    log.add(row(9, "withdraw", 1e-6, 0));
    log.add(row(10, "idle", -10e-6, 0));
    return log;
  }

  static std::string content(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  const std::string folder_ = testing::TempDir() + "training_log_test";
  TrainingConfig config_;
};

TEST_F(TrainingLogTest, ASessionIsWrittenAndEntered) {
  TrainingLog log(config_);
  const auto result = indented(log).finish(folder_, "2026-01-01T10:00:00");
  EXPECT_TRUE(result.in_history);
  EXPECT_DOUBLE_EQ(result.score.score(), 100);
  const YAML::Node yaml = YAML::LoadFile(folder_ + "/training.yaml");
  EXPECT_EQ(yaml["trainee"].as<std::string>(), "ada");
  EXPECT_EQ(yaml["outcome"].as<std::string>(), "complete");
  EXPECT_EQ(yaml["score"].as<double>(), 100);
  EXPECT_DOUBLE_EQ(yaml["measures"]["peak_force_N"]["value"].as<double>(), 1e-6);
  EXPECT_DOUBLE_EQ(yaml["measures"]["deformation_m"]["value"].as<double>(), 10e-6);
  EXPECT_DOUBLE_EQ(yaml["measures"]["time_s"]["value"].as<double>(), 8);
  EXPECT_EQ(yaml["measures"]["punctures"]["value"].as<int>(), 1);
  EXPECT_DOUBLE_EQ(yaml["measures"]["volume_m3"]["value"].as<double>(), 5e-15);
  EXPECT_DOUBLE_EQ(yaml["measures"]["volume_m3"]["reference"].as<double>(), 5e-15);
  EXPECT_NE(content(config_.history).find("\nada,2026-01-01T10:00:00,complete,1e-06,1e-05,0,8,1,5e-15,"),
            std::string::npos)
      << content(config_.history);
  EXPECT_NE(result.text.find("100 of 100 points\n  peak force        1.00 of   8.00 uN"), std::string::npos)
      << result.text;
}

TEST_F(TrainingLogTest, AFileThatCannotBeWrittenHidesNoOther) {
  std::filesystem::create_directories(folder_ + "/training.yaml");
  TrainingLog log(config_);
  const auto result = indented(log).finish(folder_, "now");
  ASSERT_EQ(result.errors.size(), 1u);
  EXPECT_NE(result.errors[0].find("training.yaml: cannot be written"), std::string::npos) << result.errors[0];
  EXPECT_TRUE(result.in_history);
  EXPECT_NE(content(config_.history).find("\nada,now,complete,"), std::string::npos);

  std::filesystem::remove(config_.history);
  std::filesystem::create_directories(config_.history);
  TrainingLog second(config_);
  const auto none = indented(second).finish(folder_, "now");
  EXPECT_EQ(none.errors.size(), 2u);
  EXPECT_FALSE(none.in_history);
  EXPECT_NE(none.text.find("100 of 100 points"), std::string::npos) << "the score is for people all the same";
}

TEST_F(TrainingLogTest, TheMeasuredForceCountsWhereItIsAskedFor) {
  config_.force = "measured";
  TrainingLog log(config_);
  EXPECT_DOUBLE_EQ(indented(log).finish(folder_, "now").score.peak_force, 2e-6);
}

/// Two membranes, another place, and back in the first hole.
TEST_F(TrainingLogTest, TheCellsPuncturesCountOnce) {
  config_.punctures = "cell";
  TrainingLog log(config_);
  int time = 0;
  const std::vector<std::pair<unsigned, std::size_t>> told = {{0, 0}, {1, 1}, {1, 1}, {2, 1}, {0, 1},
                                                              {1, 2}, {0, 2}, {2, 2}, {2, 2}};
  for (const auto& [layers, holes] : told) {
    SessionTable::Row now = row(++time, "punctured", 5e-6, 0);
    now.punctures = 7;
    now.cell.layers_punctured = layers;
    now.cell.holes = holes;
    log.add(now);
  }
  EXPECT_EQ(log.finish(folder_, "now").score.punctures, 3);
}

TEST_F(TrainingLogTest, AnUntouchedCellIsSaidAndNotEntered) {
  TrainingLog log(config_);
  log.add(row(0, "", -10e-6, 0));
  log.add(row(1, "approach", -10e-6, 0));
  const auto result = log.finish(folder_, "now");
  EXPECT_FALSE(result.in_history);
  EXPECT_EQ(result.text,
            "training of ada, session now: untouched, no points: no cell was touched; it is not in the history");
  EXPECT_EQ(YAML::LoadFile(folder_ + "/training.yaml")["outcome"].as<std::string>(), "untouched");
  EXPECT_FALSE(std::filesystem::exists(config_.history));
}

TEST_F(TrainingLogTest, RowsWithoutNeedleOrForceAreGaps) {
  TrainingLog log(config_);
  indented(log);
  SessionTable::Row gap = row(11, "idle", 50e-6, 9e-6);
  gap.needle.reset();
  log.add(gap);
  gap = row(12, "idle", 50e-6, 9e-6);
  gap.predicted.reset();
  log.add(gap);
  const auto result = log.finish(folder_, "now");
  EXPECT_TRUE(result.in_history);
  EXPECT_EQ(result.score.outcome, TrainingOutcome::kInvalid);
  EXPECT_DOUBLE_EQ(result.score.peak_force, 1e-6);
  EXPECT_NE(result.text.find("invalid, no points: needle or force was not valid in 2 of 8 moments"), std::string::npos)
      << result.text;
}

TEST(TrainingConfigTest, TheSuppliedFileIsGoodAndMistakesAreNamed) {
  YAML::Node map = loadYamlMap(std::string(MICROINJECTION_SOURCE_DIR) + "/config/training.yaml");
  map["trainee"] = "ada";
  map["history"] = "/records/history.csv";
  ConfigReader good(map, "training");
  EXPECT_EQ(TrainingConfig::read(good).task.volume, 4.8e-15);
  EXPECT_NO_THROW(good.finish());
  ConfigReader bad(YAML::Load("{trainee: 'a,b', force: none, task: {tme: 3, punctures: -1}}"), "training");
  TrainingConfig::read(bad);
  try {
    bad.finish();
    FAIL();
  } catch (const ConfigError& error) {
    for (const char* part : {"trainee", "history", "force = none", "task/tme", "task/punctures = -1"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in " << error.what();
    }
  }
}

}  // namespace
}  // namespace microinjection
