#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "cell_microinjection/CellState.h"
#include "cell_microinjection/InjectionStatus.h"
#include "nodes/session/recorded_session.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

constexpr double kPeriod = 0.005;  // s, between rows

/// The recorder alone; the test is all others.
class RecorderTest : public testing::Test {
 protected:
  RecorderTest() {
    TestNode& world = session_.world();
    // The height tells the time, and no two messages are alike.
    world.repeat<geometry_msgs::PoseStamped>(
        "needle/measured_cp", [this] { return std::optional(poseMessage(0, 0, 1e-6 * session_.now().toSec())); });
    world.repeat("cell/predicted_cf", wrenchMessage(0, 0, 1e-6));
    world.repeat("force_sensor/measured_cf", wrenchMessage(0, 0, 1e-6));
    world.publisher<cell_microinjection::CellState>("cell/state");
    world.publisher<cell_microinjection::InjectionStatus>("controller/injection_state");
  }
  void begin(const std::string& changes) {
    YAML::Node parameters = YAML::Load(changes);
    parameters["output_dir"] = out_.string();
    parameters["row_period"] = kPeriod;
    parameters["hand"] = parameters["injector"] = false;
    session_.add("session_recorder", "session_recorder", parameters);
  }
  std::vector<CsvRows::Row> rows(const std::string& name) const { return CsvRows(readFile(out_ / name)).all(); }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(out_)) names.insert(entry.path().filename());
    return names;
  }

  VirtualSession session_{{"hand.device:=none"}};
  const std::filesystem::path out_ = session_.folder() / "out";
};

TEST_F(RecorderTest, WhereNothingIsWrongNothingIsSaid) {
  begin("{bag: true}");
  session_.run(1.5);
  ASSERT_NE(session_.diagnostics().of("session_recorder: files"), nullptr);
  EXPECT_EQ(session_.diagnostics().of("session_recorder: files")->level, diagnostic_msgs::DiagnosticStatus::OK);
  EXPECT_EQ(session_.diagnostics().text("session_recorder: files"), "the session is written");
  testing::internal::CaptureStderr();
  session_.executive().end("session_recorder");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(files(), (std::set<std::string>{"force_depth.csv", "session.bag", "summary.yaml"}));
  const auto rows = this->rows("force_depth.csv");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(toNumber(rows[i].at("time_s")), kPeriod * static_cast<double>(i), 1e-9);
  }
  EXPECT_NEAR(toNumber(rows.back().at("tip_z_m")) - toNumber(rows.front().at("tip_z_m")),
              1e-6 * kPeriod * static_cast<double>(rows.size() - 1), 1e-12);
}

TEST_F(RecorderTest, KilledItLeavesTheRowsUntilThen) {
  begin("{bag: false}");
  session_.run(1.5);
  session_.executive().kill("session_recorder");
  const auto rows = this->rows("force_depth.csv.active");
  ASSERT_FALSE(rows.empty());
  const double last = toNumber(rows.back().at("time_s"));
  EXPECT_EQ(toNumber(rows.front().at("time_s")), 0);
  EXPECT_GE(last, 1.5 - 0.06);  // of which 0.05 are the patience for messages
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(std::lround(last / kPeriod)) + 1);
  EXPECT_FALSE(rows.back().at("tip_z_m").empty());
  EXPECT_FALSE(std::filesystem::exists(out_ / "force_depth.csv"));
}

TEST_F(RecorderTest, AFileThatCannotBeWrittenHidesNoOther) {
  for (const char* name : {"summary.yaml", "training.yaml"}) std::filesystem::create_directories(out_ / name);
  YAML::Node training = YAML::LoadFile(MICROINJECTION_SOURCE_DIR "/config/training.yaml");
  training["trainee"] = "ada";
  training["history"] = (out_ / "history.csv").string();
  YAML::Node changes;
  changes["training"] = training;
  begin(YAML::Dump(changes));
  session_.run(0.5);
  testing::internal::CaptureStderr();
  EXPECT_THROW(session_.executive().end("session_recorder"), std::runtime_error);
  const std::string said = testing::internal::GetCapturedStderr();
  for (const char* name : {"summary.yaml", "training.yaml"}) {
    EXPECT_NE(said.find((out_ / name).string() + ": cannot be written: "), std::string::npos) << said;
  }
  EXPECT_GT(rows("force_depth.csv").size(), 80u);
  EXPECT_GT(std::filesystem::file_size(out_ / "session.bag"), 0u);
  for (const std::string& name : files()) EXPECT_EQ(name.find(".active"), std::string::npos) << name;
}

}  // namespace
}  // namespace microinjection
