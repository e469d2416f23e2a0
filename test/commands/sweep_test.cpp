#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "commands/command_test.h"

namespace microinjection {
namespace {

constexpr char kSweep[] = R"(scene: scene.yaml
design: random
samples: 16
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
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 16 * 2);
  EXPECT_EQ(rows.substr(0, rows.find('\n')),
            "task,cell/material/young_modulus,needle/tip/radius,depth_m,force_x_N,force_y_N,force_z_N,converged,"
            "error_estimate,reason");
  for (int task = 15; task >= 0; task -= 3) {
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
  EXPECT_NE(gathered.err.find("2 of 16 tasks are missing, the first is 5"), std::string::npos) << gathered.err;
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

/// Their tasks have the same numbers and scenes, and other columns.
TEST_F(SweepTest, ASweepWithOtherKeysOverTheSameScenesHasItsOwnColumns) {
  const std::string modulus = "{key: cell/material/young_modulus, values: [17.9e3, 20e3]}";
  const std::string tip = "{key: needle/tip/radius, values: [3e-6]}";  // as in the scene
  const std::string end = "]\nindentation: {depths: [1e-6, 2e-6], model: membrane}\n";
  write("both.yaml", "scene: scene.yaml\nkeys: [" + modulus + ", " + tip + end);
  write("turned.yaml", "scene: scene.yaml\nkeys: [" + tip + ", " + modulus + end);
  write("one.yaml", "scene: scene.yaml\nkeys: [" + modulus + end);
  for (const std::string name : {"both", "turned", "one"}) {
    ASSERT_EQ(run("--file " + name + ".yaml --out shared").status, 0);
    ASSERT_EQ(run("--file " + name + ".yaml --out " + name).status, 0);
    EXPECT_EQ(table("shared"), table(name)) << name;
  }
  EXPECT_NE(table("turned").find("\n1,3e-6,20e3,1e-06,"), std::string::npos) << table("turned");
  EXPECT_NE(table("one").find("\n1,20e3,1e-06,"), std::string::npos) << table("one");
}

TEST_F(SweepTest, ATaskWithoutSolutionHasItsReasonAndEndsNoOther) {
  write("scene.yaml", scene_ + "  offset: [0, 0]\n");
  write("offset.yaml",
        "scene: scene.yaml\nkeys: [{key: needle/offset/0, values: [0, 1e-6, 0.0]}]\n"
        "indentation: {depths: [1e-6, 2e-6], model: membrane}\n");
  const Outcome outcome = run("--file offset.yaml --out out --jobs 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string rows = table("out");
  for (const char* depth : {"1e-06", "2e-06"}) {
    const std::string row = std::string("\n1,1e-6,") + depth + ",nan,nan,nan,0,nan,\"needle/offset: must be 0 with";
    EXPECT_NE(rows.find(row), std::string::npos) << rows;
    for (const char* solved : {"\n0,0,", "\n2,0.0,"})
      EXPECT_NE(rows.find(std::string(solved) + depth + ",0,0,"), std::string::npos) << rows;
  }
}

/// Only the mesh finds that the needle is too far out.
TEST_F(SweepTest, ATaskWithoutMeshHasItsReason) {
  write("scene.yaml", scene_ + "  offset: [23.5e-6, 0]\n");
  write("far.yaml",
        "scene: scene.yaml\nkeys: [{key: needle/offset/0, values: [23.5e-6]}]\nindentation: {depths: [1e-6]}\n");
  const Outcome outcome = run("--file far.yaml --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(table("out").find("\n0,23.5e-6,1e-06,nan,nan,nan,0,nan,\"needle/offset (its length) = 2.35e-05"),
            std::string::npos)
      << table("out");
}

TEST_F(SweepTest, WhatNoTaskCanDoIsRefusedWhenTheFileIsRead) {
  const std::string keys = "keys: [{key: needle/tip/radius, values: [2e-6, 3e-6]}]\n";
  write("tensegrity.yaml",
        "cell: {model: tensegrity, diameter: 56e-6, membrane: {divisions: 3},"
        " actin: {count: 10, prestrain: 0.05}, microtubules: {count: 4000},"
        " intermediate_filaments: {count: 10, prestrain: 0.05}}\n"
        "needle: {tip: {shape: disc, radius: 3e-6}}\n");
  const std::vector<std::array<std::string, 3>> cases = {
      {"scene", "model: membrane, withdraw: [0]",
       "bad.yaml: indentation/withdraw = [0]: must be left out with indentation/model = membrane"},
      {"scene", "model: live, withdraw: [0]", "must be left out with indentation/model = live"},
      {"scene", "model: membrane, hold: 2", "indentation/hold = 2: must be left out with indentation/model = membrane"},
      {"scene", "model: membrane, lateral: [1e-6, 0]", "indentation/lateral = [1e-6, 0]: must be 0 with"},
      {"scene", "withdraw: [0, 1e-6]", "withdrawal: 1e-06 m must be below the depth before"},
      {"scene", "model: axisymmetric, lateral: [1e-6, 0]", "lateral must be 0"},
      {"tensegrity", "tolerance: 0.01, element: p2",
       "indentation/element = p2: must be left out for a scene of cell/model = tensegrity"},
      {"tensegrity", "tolerance: 0.01", "indentation/tolerance = 0.01: must be left out"},
      {"scene", "speed: 10", "indentation/speed = 10: must be 1e-10 .. 1 m/s; 10 um/s would be 1e-5"},
      {"tensegrity", "model: spatial", "cell/model = tensegrity: must be continuum"}};
  for (const auto& [scene, options, message] : cases) {
    write("bad.yaml", "scene: " + scene + ".yaml\n" + keys + "indentation: {depths: [1e-6], " + options + "}\n");
    const Outcome outcome = run("--file bad.yaml --list");
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  }
}

TEST_F(SweepTest, BadUsageIsNamed) {
  const auto fails = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  };
  fails("--list", "--file is missing");
  fails("--file sweep.yaml", "one of --list and --out must be given");
  fails("--file sweep.yaml --out out --task 16", "--task = 16: must be below 16");
  fails("--file sweep.yaml --out out --task -1", "--task = -1: must be 0 or more");
  fails("--file sweep.yaml --out out --task 1 --gather", "only one may be given");
  fails("--file absent.yaml --list", "absent.yaml: cannot be read");
  std::string bad = kSweep;
  write("bad.yaml", bad.replace(bad.find("young_modulus"), 13, "young_modulis"));
  fails("--file bad.yaml --list", "bad.yaml: task 0: cell/material/young_modulis");
  bad = kSweep;
  write("bad.yaml", bad.replace(bad.find("16"), 2, "016"));
  fails("--file bad.yaml --list", "bad.yaml, line 3: samples = 016: must be written without the leading zero");
  bad = kSweep;
  write("bad.yaml", bad.replace(bad.find("2e-6, 3e-6"), 4, "0002"));
  fails("--file bad.yaml --list", "task 0: needle/tip/radius = 0002: must be written without the leading zero");
  EXPECT_EQ(run("--file sweep.yaml --list").status, 0);
  EXPECT_NE(run("--help").out.find("sweep --file FILE"), std::string::npos);
}

TEST_F(SweepTest, ThePathOfTheSceneIsFromTheFileOrFromHome) {
  std::filesystem::create_directories(directory_ + "home/cells");
  std::filesystem::create_directories(directory_ + "sweeps");
  write("home/cells/scene.yaml", scene_);
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("HOME", (directory_ + "home").c_str(), 1);
  for (const char* path : {"~/cells/scene.yaml", "../home/cells/scene.yaml"}) {
    std::string sweep = kSweep;
    write("sweeps/sweep.yaml", sweep.replace(sweep.find("scene.yaml"), 10, path));
    const Outcome outcome = run("--file sweeps/sweep.yaml --list");
    EXPECT_EQ(outcome.status, 0) << path << "\n" << outcome.err;
  }
  setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace microinjection
