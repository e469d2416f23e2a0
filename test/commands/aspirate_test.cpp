// The command as its users run it.

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "commands/command_test.h"

namespace microinjection {
namespace {

constexpr char kAspirateHeader[] =
    "pressure_Pa,tongue_length_m,tongue_volume_m3,seal_radius_m,clamping_force_N,converged,error_estimate";

class AspirateCommand : public CommandTest {
 protected:
  AspirateCommand() : CommandTest(MICROINJECTION_ASPIRATE, "aspirate") {}

  void SetUp() override {
    CommandTest::SetUp();
    std::ofstream(directory_ + "held.yaml")
        << "cell: {diameter: 80e-6, material: {model: neo_hookean, young_modulus: 5e3, poisson_ratio: 0.49}}\n"
        << "holding_pipette:\n  mouth: {inner_radius: 12e-6, outer_radius: 32e-6, edge_radius: 4e-6, pressure: -500, "
        << "contact: {mode: sliding}}\n"
        << "needle: {tip: {shape: hemisphere, radius: 4e-6}}\n";
  }

  static std::vector<std::vector<double>> rows(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, kAspirateHeader);
    std::vector<std::vector<double>> table;
    while (std::getline(lines, line)) {
      std::vector<double>& row = table.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    }
    return table;
  }
};

TEST_F(AspirateCommand, WritesARowForEachPressureInTheOrderGiven) {
  const Outcome done = run("--scene held.yaml --pressures=-500,-50,-250");
  EXPECT_EQ(done.status, 0) << done.err;
  const auto table = rows(done.out);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0][0], -500);
  EXPECT_EQ(table[1][0], -50);
  EXPECT_GT(table[0][1], table[2][1]);  // the more suction, the longer the tongue
  EXPECT_GT(table[2][1], table[1][1]);
  for (const auto& row : table) {
    EXPECT_NEAR(row[4], -row[0] * M_PI * row[3] * row[3], 0.005 * row[4]);
    EXPECT_EQ(row[5], 1);
    EXPECT_LT(row[6], 0.005);
  }
}

TEST_F(AspirateCommand, TakesTheScenesPressure) {
  const Outcome done = run("--scene held.yaml --csv tongue.csv");
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(rows(read(directory_ + "tongue.csv")).at(0).at(0), -500);
}

/// Of its own modulus as suction there is no equilibrium: the row says so, and the weaker one is there.
TEST_F(AspirateCommand, SaysWhereTheCellIsDrawnIn) {
  const Outcome done = run("--scene held.yaml --pressures=-100,-5000 --tolerance 0.05");
  EXPECT_EQ(done.status, 3);
  const auto table = rows(done.out);
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[0][5], 1);
  EXPECT_EQ(table[1][5], 0);
  EXPECT_TRUE(std::isnan(table[1][1]));
  EXPECT_NE(done.err.find("-5000 Pa: not converged: "), std::string::npos) << done.err;
}

/// `indent` solves a held cell on its axis, and says why not beside it.
TEST_F(AspirateCommand, IndentTakesTheSameScene) {
  const auto indent = [&](const std::string& more) {
    return std::system(("cd " + directory_ + " && " MICROINJECTION_INDENT " --scene held.yaml --depths 4e-6 " + more +
                        " >out.txt 2>err.txt")
                           .c_str());
  };
  ASSERT_EQ(WEXITSTATUS(indent("--tolerance 0.02")), 0) << read(directory_ + "err.txt");
  EXPECT_NE(read(directory_ + "out.txt").find(",1,"), std::string::npos);  // converged
  EXPECT_EQ(WEXITSTATUS(indent("--lateral 1e-6,0")), 2);
  EXPECT_NE(read(directory_ + "err.txt").find("holding_pipette/mouth: must be left out for a needle beside the axis"),
            std::string::npos);
}

TEST_F(AspirateCommand, NamesWhatIsWrong) {
  std::ofstream(directory_ + "glued.yaml")
      << "cell: {diameter: 80e-6, material: {model: neo_hookean, young_modulus: 5e3, poisson_ratio: 0.49}}\n"
      << "holding_pipette: {contact_radius: 12e-6}\nneedle: {tip: {shape: hemisphere, radius: 4e-6}}\n";
  for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
           {"", "--scene is missing"},
           {"--scene held.yaml --pressures=3", "--pressures = 3: each must be <= 0 (Pa)"},
           {"--scene held.yaml --pressures=-3,x", "'x' is not a number"},
           {"--scene held.yaml --tolerance 0", "--tolerance = 0: must be a number > 0"},
           {"--scene glued.yaml --pressures=-3", "holding_pipette/mouth: is missing"},
           {"--scene held.yaml --csv held.yaml", "held.yaml"}}) {
    const Outcome done = run(arguments);
    EXPECT_EQ(done.status, 2) << arguments;
    EXPECT_NE(done.err.find(told), std::string::npos) << arguments << '\n' << done.err;
  }
}

}  // namespace
}  // namespace microinjection
