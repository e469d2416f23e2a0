// The command as its users run it.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "commands/command_test.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

class IndentCommand : public CommandTest {
 protected:
  IndentCommand() : CommandTest(MICROINJECTION_INDENT, "indent") {}

  void SetUp() override {
    CommandTest::SetUp();
    write("scene.yaml", "linear", "");
    write("st_vk.yaml", "st_venant_kirchhoff", "");
  }

  void write(const std::string& name, const std::string& model, const std::string& more) const {
    std::ofstream(directory_ + name) << "cell: {diameter: 56e-6, material: {model: " << model
                                     << ", young_modulus: 17.9e3, poisson_ratio: 0.49}}\n"
                                     << "holding_pipette: {contact_radius: 10e-6}\n"
                                     << "needle: {tip: {shape: disc, radius: 3e-6}}\n"
                                     << "mesh: {size: 20e-6}\n"
                                     << more;
  }

  /// Numbers of the table; the header must be the one that is promised.
  static std::vector<std::vector<double>> table(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged,error_estimate");
    std::vector<std::vector<double>> rows;
    while (std::getline(lines, line)) {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
      EXPECT_EQ(rows.back().size(), 7u);
    }
    return rows;
  }
};

TEST_F(IndentCommand, WritesARowADepthInTheOrderGiven) {
  const Outcome result = run("--scene scene.yaml --depths 2e-6,0,1e-6 --csv force.csv");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const auto rows = table(read(directory_ + "force.csv"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0][0], 2e-6);
  EXPECT_EQ(rows[1][0], 0);
  EXPECT_EQ(rows[2][0], 1e-6);
  EXPECT_GT(rows[2][3], 0.1e-6);
  EXPECT_NEAR(rows[0][3] / rows[2][3], 2, 1e-6);  // linear
  EXPECT_EQ(rows[1][3], 0);
  for (const auto& row : rows) {
    EXPECT_EQ(row[5], 1);
    EXPECT_LE(row[6], 0.005);  // the default tolerance on the axis
  }
}

TEST_F(IndentCommand, MeetsTheToleranceThatIsAskedFor) {
  const Outcome result = run("--scene scene.yaml --depths 1e-6 --tolerance 0.002");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto row = table(result.out).at(0);
  EXPECT_LE(row[6], 0.002);
  EXPECT_NEAR(row[3], 0.11688e-6, 0.005 * 0.11688e-6);  // test/reference/linear.csv
}

TEST_F(IndentCommand, SaysSoWhenTheToleranceCannotBeMet) {
  const Outcome result = run("--scene st_vk.yaml --depths 0.9e-6 --tolerance 1e-4");
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("above the tolerance"), std::string::npos);
  EXPECT_GT(table(result.out).at(0)[6], 1e-4);
}

TEST_F(IndentCommand, TheLiveModelLocks) {
  const Outcome result = run("--scene scene.yaml --depths 1e-6,2e-6 --model live");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = table(result.out);
  EXPECT_GT(rows[0][3], 1.5 * 0.11688e-6);
  EXPECT_NEAR(rows[1][3] / rows[0][3], 2, 1e-8);  // linear
  EXPECT_TRUE(std::isnan(rows[0][6]));
}

TEST_F(IndentCommand, WritesToTheStandardOutputByDefault) {
  const Outcome result = run("--scene scene.yaml --depths 1e-6");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(table(result.out).size(), 1u);
  EXPECT_EQ(run("--scene scene.yaml --depths 1e-6 --csv -").status, 0);
  EXPECT_FALSE(fs::exists(directory_ + "-"));
}

/// A disk that is full is a table that is not there.
TEST_F(IndentCommand, OutputThatCannotBeWrittenIsAnError) {
  const std::string indent = "cd " + directory_ + " && " MICROINJECTION_INDENT " ";
  const std::string call = "--scene scene.yaml --depths 1e-6 --model live ";
  for (const std::string& end : {call + ">/dev/full", call + ">&-", std::string("--help >/dev/full")}) {
    EXPECT_EQ(WEXITSTATUS(std::system((indent + end + " 2>err.txt").c_str())), 2) << end;
    EXPECT_NE(read(directory_ + "err.txt").find("indent: the standard output: cannot be written: "), std::string::npos)
        << end;
  }
  const Outcome full = run(call + "--csv /dev/full");
  EXPECT_EQ(full.status, 2);
  EXPECT_NE(full.err.find("/dev/full: cannot be written: No space left"), std::string::npos) << full.err;
}

TEST_F(IndentCommand, MovesSidewaysBothWays) {
  const Outcome there = run("--scene scene.yaml --depths 1e-6 --lateral 1e-6,-2e-6");
  const Outcome back = run("--scene scene.yaml --depths 1e-6 --lateral -1e-6,2e-6");
  const Outcome down = run("--scene scene.yaml --depths 1e-6 --model spatial");
  ASSERT_EQ(there.status, 0) << there.err;
  ASSERT_EQ(back.status, 0) << back.err;
  const auto a = table(there.out).at(0), b = table(back.out).at(0), c = table(down.out).at(0);
  EXPECT_LT(a[1], 0);  // the cell pushes back
  EXPECT_GT(a[2], 0);
  for (int i = 1; i <= 3; ++i) EXPECT_NEAR(a[i] + b[i], 2 * c[i], 0.02 * c[3]);  // linear
}

TEST_F(IndentCommand, RowsThatDoNotConvergeAreWrittenAsSuch) {
  const Outcome result = run("--scene st_vk.yaml --depths 0.25e-6,30e-6,0.5e-6");
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("not converged: "), std::string::npos);
  const auto rows = table(result.out);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0][5], 1);
  EXPECT_EQ(rows[1][5], 0);
  for (int i = 1; i <= 3; ++i) EXPECT_TRUE(std::isnan(rows[1][i]));
  EXPECT_EQ(rows[2][5], 1);
  EXPECT_GT(rows[2][3], 0);
}

TEST_F(IndentCommand, RefusesBadUsageWithTheKeyAndWhatIsAllowed) {
  write("bad.yaml", "linear", "needel: 1\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--depths 1e-6", "--scene is missing"},
      {"--scene scene.yaml", "--depths is missing"},
      {"--scene none.yaml --depths 1e-6", "none.yaml: cannot be read"},
      {"--scene bad.yaml --depths 1e-6", "needel: unknown key"},
      {"--scene scene.yaml --depths 1e-6,-1e-6", "each must be >= 0"},
      {"--scene scene.yaml --depths 1e-6,,2e-6", "'' is not a number"},
      {"--scene scene.yaml --depths 1um", "'1um' is not a number"},
      {"--scene scene.yaml --depths nan", "'nan' is not a number"},
      {"--scene scene.yaml --depths 1e-6 --lateral 1e-6", "two numbers X,Y"},
      {"--scene scene.yaml --depths 1e-6 --depth 1e-6", "depth"},
      {"--scene scene.yaml --depths 1e-6 --tolerance 0", "--tolerance = 0: must be a number > 0"},
      {"--scene scene.yaml --depths 1e-6 --model 2d",
       "--model = 2d: must be one of: auto, axisymmetric, spatial, live, membrane"},
      {"--scene scene.yaml --depths 1e-6 --element q1", "--element = q1: must be one of: p1, mini"},
      {"--scene scene.yaml --depths 1e-6 --speed -1", "--speed = -1: must be a number > 0"},
      {"--scene scene.yaml --depths 1e-6 --model axisymmetric --lateral 1e-6,0", "lateral must be 0"},
      {"--scene scene.yaml --depths 1e-6 --withdraw 0 --model live",
       "--withdraw = 0: must be left out with --model = live"},
      {"--scene scene.yaml --depths 1", "--depths = 1: must be 0 .. 5.6e-5 m; 1 um would be 1e-6"},
      {"--scene scene.yaml --depths 1e-6,57e-6", "--depths = 1e-6,57e-6: must be 0 .. 5.6e-5 m (the cell's diameter"},
      {"--scene scene.yaml --depths 1e-6 --lateral 1,0", "--lateral = 1,0: must be 0 .. 5.6e-5 m; 1 um would be 1e-6"},
      {"--scene scene.yaml --depths 1e-6 --withdraw 0,-2", "--withdraw = 0,-2: must be -5e-3 .. 5e-3 m; -2 um"},
      {"--scene scene.yaml --depths 1e-6 --speed 10", "--speed = 10: must be 1e-10 .. 1 m/s; 10 um/s would be 1e-5"},
      {"--scene scene.yaml --depths 1e-6 stray", "positional"},
      {"--scene scene.yaml --depths 1e-6 --csv scene.yaml/force.csv", "scene.yaml/force.csv: cannot be written"}};
  for (const auto& [arguments, message] : cases) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_NE(result.err.find(message), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out, "") << arguments;
  }
}

TEST_F(IndentCommand, TheMembraneIsCubic) {
  write("membrane.yaml", "linear", "");
  const std::string text = read(directory_ + "membrane.yaml");
  std::ofstream(directory_ + "membrane.yaml")
      << "cell: {biomembrane: {thickness: 4e-6, dimple_radius: 20e-6}," << text.substr(text.find('{') + 1);
  const Outcome result = run("--scene membrane.yaml --depths 2e-6,4e-6 --model membrane");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = table(result.out);
  EXPECT_GT(rows[0][3], 0);
  EXPECT_NEAR(rows[1][3] / rows[0][3], 8, 1e-6);
  EXPECT_TRUE(std::isnan(rows[0][6]));
  const Outcome none = run("--scene scene.yaml --depths 2e-6 --model membrane --speed 1e-6");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("cell/biomembrane is missing"), std::string::npos);
  EXPECT_NE(none.err.find("--speed = 1e-6: must be left out with --model = membrane"), std::string::npos) << none.err;
}

TEST_F(IndentCommand, DrawsTheTipBack) {
  const std::string depths = "--scene scene.yaml --depths 1e-6,2e-6 ";
  const Outcome result = run(depths + "--withdraw 1e-6,0,-1e-6");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto rows = table(result.out);
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_NEAR(rows[2][3], rows[0][3], 1e-6 * rows[0][3]);  // elastic: as on the way in
  EXPECT_NEAR(rows[3][3], 0, 1e-6 * rows[0][3]);
  EXPECT_NEAR(rows[4][3], -rows[0][3], 1e-6 * rows[0][3]);  // a disc sticks
  EXPECT_EQ(run(depths + "--withdraw 1e-6 --model live").status, 2);
  const Outcome deeper = run(depths + "--withdraw 1e-6,1.5e-6");
  EXPECT_EQ(deeper.status, 2);
  EXPECT_NE(deeper.err.find("must be below the depth before"), std::string::npos) << deeper.err;
}

/// It has one model and no finer meshes.
TEST_F(IndentCommand, ATensegrityRefusesWhatItWouldIgnore) {
  std::ofstream(directory_ + "tensegrity.yaml")
      << "cell: {model: tensegrity, diameter: 56e-6, membrane: {divisions: 3},"
      << " actin: {count: 10, prestrain: 0.05}, microtubules: {count: 4000},"
      << " intermediate_filaments: {count: 10, prestrain: 0.05}}\n"
      << "needle: {tip: {shape: disc, radius: 3e-6}}\n";
  const std::string call = "--scene tensegrity.yaml --depths 1e-6";
  const Outcome served = run(call);
  ASSERT_EQ(served.status, 0) << served.err;
  EXPECT_GT(table(served.out).at(0)[3], 0);
  const Outcome refused = run(call + " --tolerance 0.01 --element p2_p0 --time 600 --withdraw 0");
  EXPECT_EQ(refused.status, 2);
  for (const char* option : {"--tolerance = 0.01", "--element = p2_p0", "--time = 600", "--withdraw = 0"}) {
    EXPECT_NE(refused.err.find(std::string(option) + ": must be left out"), std::string::npos) << refused.err;
  }
}

TEST_F(IndentCommand, ExplainsItself) {
  const Outcome result = run("--help");
  EXPECT_EQ(result.status, 0);
  for (const char* word :
       {"--scene", "--depths", "--lateral", "--csv", "depth_m,force_x_N", "Example:", "Exit status:"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace microinjection
