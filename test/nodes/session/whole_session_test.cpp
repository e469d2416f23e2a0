#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "nodes/executive/simulation.h"
#include "nodes/session/recorded_session.h"
#include "nodes/session/training_measures.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

constexpr char kTask[] =  // some of it is met, some is not
    "force: measured\n"
    "task: {peak_force: 0.7e-6, deformation: 5e-6, lateral_error: 1e-6, time: 7.0, punctures: 3, volume: 6e-15}\n";

/// What a session of a virtual hand over a live cell leaves, twice.
struct Recorded {
  Recorded() {
    std::ofstream(folders.path() / "task.yaml") << kTask;
    const std::string motion = writeMotion(folders.path() / "motion.yaml", kHandPath);
    for (const char* name : {"first", "second"}) {
      const std::string folder = (folders.path() / name).string();
      const Session session =
          Session::load("default",
                        {"cell:=" + testFile("scenes/injected_oocyte.yaml"), "model:=live", "hand.motion:=" + motion,
                         "record.folder:=" + folder, "record.end_when_done:=true", "record.trainee:=ada",
                         "record.history:=" + (folders.path() / "history.csv").string(),
                         "record.training:=" + (folders.path() / "task.yaml").string()},
                        MICROINJECTION_SOURCE_DIR);
      results.push_back(simulate(session, {}));
    }
    rows = CsvRows(file("second", "force_depth.csv")).all();
  }
  std::string file(const std::string& session, const std::string& name) const {
    return readFile(folders.path() / session / name);
  }

  UserFolders folders;
  std::vector<SimulationResult> results;
  std::vector<CsvRows::Row> rows;  ///< of the second
};

class WholeSessionTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { recorded_ = std::make_unique<Recorded>(); }
  static void TearDownTestSuite() { recorded_.reset(); }

  static const std::vector<CsvRows::Row>& rows() { return recorded_->rows; }
  static std::vector<double> numbers(const std::string& column, const std::set<std::string>& phases) {
    std::vector<double> values;
    for (const auto& row : rows()) {
      if (phases.count(row.at("phase")) > 0 && !row.at(column).empty()) values.push_back(toNumber(row.at(column)));
    }
    return values;
  }

  static std::unique_ptr<Recorded> recorded_;
};
std::unique_ptr<Recorded> WholeSessionTest::recorded_;

TEST_F(WholeSessionTest, EndsByItselfWithoutAFault) {
  for (const SimulationResult& result : recorded_->results) {
    EXPECT_TRUE(result.done);
    EXPECT_EQ(result.failures, std::vector<std::string>());
    EXPECT_EQ(result.warnings, std::vector<std::string>());
  }
}

TEST_F(WholeSessionTest, TwoRunsWriteTheSameBytes) {
  for (const char* name : {"force_depth.csv", "summary.yaml", "training.yaml", "notebook.csv", "session.bag"}) {
    EXPECT_TRUE(recorded_->file("first", name) == recorded_->file("second", name)) << name << " differs";
  }
}

TEST_F(WholeSessionTest, TheNeedleTouchesIndentsAndComesOut) {
  std::set<std::string> phases;
  for (const auto& row : rows()) phases.insert(row.at("phase"));
  phases.erase("");
  phases.erase("done");
  EXPECT_EQ(phases, (std::set<std::string>{"approach", "touch", "indent", "hold", "puncture", "inject", "retract"}));
  const auto touched =
      std::find_if(rows().begin(), rows().end(), [](auto& row) { return row.at("in_contact") == "1"; });
  ASSERT_NE(touched, rows().end());
  EXPECT_LT(std::abs(toNumber(touched->at("depth_m"))), 0.06e-6);  // of 10 um/s in the 5 ms of a row
  const std::vector<double> depths = numbers("depth_m", {"indent", "hold"});
  const double deepest = *std::max_element(depths.begin(), depths.end());
  EXPECT_GT(deepest, 2.5e-6);  // of 4 um meant: the hand yields
  EXPECT_LT(deepest, 4.1e-6);
  const std::vector<double> forces = numbers("predicted_axial_N", {"indent", "hold"});
  EXPECT_GT(*std::max_element(forces.begin(), forces.end()), 0.3e-6);
  EXPECT_EQ(numbers("predicted_axial_N", {"retract"}).back(), 0);
}

TEST_F(WholeSessionTest, TheSummaryHasTheStepsOfEachNode) {
  const YAML::Node summary = YAML::Load(recorded_->file("second", "summary.yaml"));
  EXPECT_EQ(summary["clock"].as<std::string>(), "virtual");
  std::set<std::string> topics;
  for (const auto& node : summary["nodes"]) {
    topics.insert(node["topic"].as<std::string>());
    const double rate = node["rate_hz"].as<double>();
    EXPECT_GT(node["count"].as<int>(), 1000) << node;
    EXPECT_NEAR(rate, 100 * std::round(rate / 100), 1e-3 * rate) << node;
  }
  for (const char* topic : {"/cell/predicted_cf", "/haptic/servo_cf", "/needle/servo_cp"}) {
    EXPECT_EQ(topics.count(topic), 1u) << topic;
  }
}

/// At rest in the cell the springs of hand and coupling, in series, are in balance with the rendered force.
TEST_F(WholeSessionTest, TheHandYields) {
  const auto held = std::find_if(rows().rbegin(), rows().rend(), [](auto& row) { return row.at("phase") == "hold"; });
  ASSERT_NE(held, rows().rend());
  const double force = toNumber(held->at("hand_force_N")), depth = toNumber(held->at("depth_m"));
  EXPECT_NEAR(force, 2e5 * toNumber(held->at("predicted_axial_N")), 0.02 * force);
  const double yielded = force / 400 + force / 2000;  // m, of hand (N/m) and coupling
  EXPECT_NEAR(depth + 1e-3 * yielded, 4e-6, 0.03e-6);
}

/// Through the membrane, the operator's word, the pulse and its volume.
TEST_F(WholeSessionTest, TheHandInjects) {
  std::vector<std::string> states;
  std::vector<double> volumes;
  for (const auto& row : rows()) {
    const std::string& state = row.at("injection_state");
    // By hand idle lasts one cycle, which a row each 5 ms may miss.
    if (!state.empty() && state != "idle" && (states.empty() || states.back() != state)) states.push_back(state);
    if (state == "inject") volumes.push_back(toNumber(row.at("injected_volume_m3")));
  }
  const auto indent = std::find(states.begin(), states.end(), "indent");
  EXPECT_EQ(std::vector<std::string>(indent, states.end()),
            (std::vector<std::string>{"indent", "punctured", "inject", "punctured", "withdraw", "approach"}));
  EXPECT_EQ(rows().back().at("layers_punctured"), "2");
  EXPECT_EQ(rows().back().at("punctures_felt"), "0");
  const double pipette =
      2.46e3 / 1.546e17;  // m^3/s: of the pulse's 3 kPa past the capillary pressure, over the resistance
  EXPECT_NEAR((volumes.back() - volumes.front()) / (0.3 * pipette), 1, 0.05);
}

/// The measures of the score, once more from the table; score and history.
TEST_F(WholeSessionTest, TheSessionIsScored) {
  const YAML::Node told = YAML::Load(recorded_->file("second", "training.yaml"));
  EXPECT_EQ(told["trainee"].as<std::string>(), "ada");
  EXPECT_EQ(told["outcome"].as<std::string>(), "complete");
  EXPECT_EQ(told["reason"].as<std::string>(), "");
  EXPECT_EQ(told["moments_left_out"].as<int>(), 0);
  const YAML::Node task = YAML::Load(kTask)["task"];
  const std::vector<CsvRows::Row> history = CsvRows(readFile(recorded_->folders.path() / "history.csv")).all();
  ASSERT_EQ(history.size(), 2u);
  EXPECT_EQ(history[0], history[1]);
  EXPECT_EQ(history[1].at("trainee"), "ada");
  double points = 0;
  for (const RecordedMeasure& measure : trainingMeasures(rows())) {
    SCOPED_TRACE(measure.name);
    const YAML::Node row = told["measures"][measure.name];
    EXPECT_NEAR(row["value"].as<double>() / measure.value, 1, 1e-5);
    EXPECT_NEAR(toNumber(history[1].at(measure.name)) / measure.value, 1, 1e-5);
    const double ratio = measure.value / task[measure.task].as<double>();
    const double share = measure.is_met_exactly ? 1 - std::abs(ratio - 1) : std::min(1., 2 - ratio);
    EXPECT_GT(share, 0) << "a task that tells something";
    EXPECT_NEAR(row["points"].as<double>() / (share * row["of"].as<double>()), 1, 1e-4);
    points += share * row["of"].as<double>();
    if (measure.name == "punctures") {
      EXPECT_EQ(measure.value, 2);
    }
  }
  EXPECT_NEAR(told["score"].as<double>(), points, 1e-3);
}

}  // namespace
}  // namespace microinjection
