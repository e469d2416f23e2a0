#include <algorithm>
#include <vector>

#include "commands/command_test.h"

namespace microinjection {
namespace {

constexpr char kSweep[] = R"(scene: scene.yaml
design: random
samples: 40
keys:
  - {key: cell/material/young_modulus, from: 10e3, to: 20e3}
  - {key: needle/tip/radius, values: [2e-6, 3e-6]}
indentation: {depths: [1e-6, 2e-6], model: membrane}
)";

class SweepTest : public CommandTest {
 protected:
  SweepTest() : CommandTest(MICROINJECTION_SWEEP, "sweep") {}

  void SetUp() override {
    CommandTest::SetUp();
    write("scene.yaml", scene_);
    write("sweep.yaml", kSweep);
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(directory_ + name) << text; }
  std::string table(const std::string& folder) const { return read(directory_ + folder + "/sweep.csv"); }

  const std::string scene_ = read(MICROINJECTION_SOURCE_DIR "/test/commands/membrane.yaml");
};

TEST_F(SweepTest, TheTableIsTheSameBytesWhoeverSolvedTheTasks) {
  const Outcome whole = run("--file sweep.yaml --out whole --jobs 2");
  ASSERT_EQ(whole.status, 0) << whole.err;
  const std::string rows = table("whole");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 40 * 2);
  EXPECT_EQ(rows.substr(0, rows.find('\n')),
            "task,cell/material/young_modulus,needle/tip/radius,depth_m,force_x_N,force_y_N,force_z_N,converged,"
            "error_estimate,reason");
  for (int task = 39; task >= 0; task -= 3) {
    const int first = std::max(0, task - 2);
    const std::string count = std::to_string(task - first + 1);
    ASSERT_EQ(run("--file sweep.yaml --out parts --task " + std::to_string(first) + " --count " + count).status, 0);
  }
  ASSERT_EQ(run("--file sweep.yaml --out parts --gather").status, 0);
  EXPECT_EQ(table("parts"), rows);
}

TEST_F(SweepTest, RowsAreTheForcesOfIndent) {
  write("one.yaml",
        "scene: scene.yaml\nkeys: [{key: cell/material/young_modulus, values: [12e3]}]\n"
        "indentation: {depths: [2e-6], model: membrane}\n");
  ASSERT_EQ(run("--file one.yaml --out one").status, 0);
  std::string scene = scene_;
  scene.replace(scene.find("17.9e3"), 6, "12e3");
  write("twelve.yaml", scene);
  const std::string command = std::string("cd ") + directory_ + " && " + MICROINJECTION_INDENT +
                              " --scene twelve.yaml --depths 2e-6 --model membrane >indent.csv 2>/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string row = read(directory_ + "indent.csv"), swept = table("one");
  const std::string forces = row.substr(row.find('\n') + 1, row.find(",0.0") - row.find('\n') - 1);
  EXPECT_NE(swept.find(forces.substr(0, forces.find_last_of(','))), std::string::npos) << swept << forces;
}

TEST_F(SweepTest, WhatIsMissingOrDamagedIsNamedAndSolvedAgain) {
  ASSERT_EQ(run("--file sweep.yaml --out out").status, 0);
  const std::string rows = table("out");
  std::filesystem::remove(directory_ + "out/task_00000005");
  write("out/task_00000007", "damage");
  Outcome gathered = run("--file sweep.yaml --out out --gather");
  EXPECT_EQ(gathered.status, 2);
  EXPECT_NE(gathered.err.find("2 of 40 tasks are missing, the first is 5"), std::string::npos) << gathered.err;
  EXPECT_EQ(table("out"), rows) << "an older table stays";
  const Outcome again = run("--file sweep.yaml --out out");
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.err.find("task_00000007"), std::string::npos) << again.err;
  EXPECT_EQ(table("out"), rows);
  // Results of another sweep in the same folder are not taken for this one's.
  std::string other = kSweep;
  write("other.yaml", other.replace(other.find("20e3"), 4, "30e3"));
  EXPECT_EQ(run("--file other.yaml --out out --gather").status, 2);
}

TEST_F(SweepTest, BadUsageIsNamed) {
  const auto fails = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  };
  fails("--list", "--file is missing");
  fails("--file sweep.yaml", "one of --list and --out must be given");
  fails("--file sweep.yaml --out out --task 40", "--task = 40: must be below 40");
  fails("--file sweep.yaml --out out --task -1", "--task = -1: must be 0 or more");
  fails("--file sweep.yaml --out out --task 1 --gather", "only one may be given");
  fails("--file absent.yaml --list", "absent.yaml: cannot be read");
  std::string bad = kSweep;
  write("bad.yaml", bad.replace(bad.find("young_modulus"), 13, "young_modulis"));
  fails("--file bad.yaml --list", "bad.yaml: task 0: cell/material/young_modulis");
  EXPECT_EQ(run("--file sweep.yaml --list").status, 0);
  EXPECT_NE(run("--help").out.find("sweep --file FILE"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
