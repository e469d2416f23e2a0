// The command as its users run it.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "commands/command_test.h"
#include "vision/microscope/microscope.h"
#include "vision/microscope/tongue_outline.h"

namespace microinjection {
namespace {

constexpr char kCells[] = MICROINJECTION_SOURCE_DIR "/config/cells/";
constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";

class IdentifyCommand : public CommandTest {
 protected:
  IdentifyCommand() : CommandTest(MICROINJECTION_IDENTIFY, "identify") {}

  Outcome run(const std::string& arguments) const { return CommandTest::run(arguments + " --families " + kFamilies); }

  /// {value, low, high} of the modulus in the table of --csv.
  std::vector<double> modulus(const std::string& model) const { return found(model, "young_modulus"); }

  /// Same of any quantity.
  std::vector<double> found(const std::string& model, const std::string& quantity) const {
    std::istringstream lines(read(directory_ + "found.csv"));
    for (std::string line; std::getline(lines, line);) {
      const std::string head = model + ',' + quantity + ',';
      if (line.rfind(head, 0) != 0) continue;
      std::vector<double> values;
      std::istringstream cells(line.substr(head.size()));
      for (std::string cell; values.size() < 3 && std::getline(cells, cell, ',');) values.push_back(std::stod(cell));
      return values;
    }
    ADD_FAILURE() << "no " << quantity << " of " << model;
    return {0, 0, 0};
  }

  /// A mouse's oocyte of model ogden under a round tip.
  void writeStiffening(const std::string& name, double exponent) const {
    std::ofstream(directory_ + name) << "cell: {diameter: 56e-6, material: {model: ogden, young_modulus: 17.9e3, "
                                        "poisson_ratio: 0.49, ogden_exponent: "
                                     << exponent << "}}\nholding_pipette: {contact_radius: 10e-6}\n"
                                     << "needle: {tip: {shape: hemisphere, radius: 6e-6}, contact: {mode: sticking}}\n";
  }

  /// A record of the depths and forces that `indent` has written, behind an approach without force.
  void writeApproachAnd(const std::string& solved, double noise) const {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::ofstream file(directory_ + "record.csv");
    file.precision(12);
    file << "position_m,force_N\n";
    for (int i = -100; i < 0; ++i) file << 0.1e-6 * i << ',' << noise * normal(random) << '\n';
    std::istringstream lines(read(directory_ + solved));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      double depth = 0, force = 0;
      ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%*[^,],%*[^,],%lf", &depth, &force), 2) << line;
      file << depth << ',' << force + noise * normal(random) << '\n';
    }
  }

  /// A record of a linear cell under a disc, whose force is the slope times the depth.
  void writeLinear(double slope) const {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::ofstream file(directory_ + "record.csv");
    file.precision(12);
    file << "time_s,position_m,force_N\n";
    for (int i = 0; i < 400; ++i) {
      const double position = 20e-9 * i, depth = position - 3e-6;
      file << 1e-3 * i << ',' << position << ',' << slope * std::max(0.0, depth) + 1e-9 * normal(random) << '\n';
    }
  }
};

// `indent` gives the force of the scene, so that the modulus of the point is the scene's.
TEST_F(IdentifyCommand, APointHasTheModulusOfTheSceneThatIndentSolves) {
  const std::string scene = std::string(kCells) + "mouse_oocyte.yaml";
  const std::string indent = "cd " + directory_ + " && " MICROINJECTION_INDENT " --scene " + scene +
                             " --depths 3e-6 --csv force.csv 2>/dev/null";
  ASSERT_EQ(std::system(indent.c_str()), 0);
  std::istringstream lines(read(directory_ + "force.csv"));
  std::string cell;
  std::getline(lines, cell);
  for (int i = 0; i < 4; ++i) std::getline(lines, cell, ',');
  const Outcome outcome = run("--point 3e-6," + cell + " --reading-error 0.05 --model solution --scene " + scene +
                              " --csv found.csv --out fitted.yaml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<double> found = modulus("solution");
  EXPECT_NEAR(found[0], 17.9e3, 0.005 * 17.9e3);
  EXPECT_NEAR(found[1], 0.95 * found[0], 0.005 * found[0]);
  EXPECT_NEAR(found[2], 1.05 * found[0], 0.005 * found[0]);
  EXPECT_NE(read(directory_ + "fitted.yaml").find("young_modulus: 17"), std::string::npos);
  EXPECT_NE(outcome.out.find("not tested"), std::string::npos) << outcome.out;
}

/// What `aspirate` solves has the scene's modulus, whatever modulus the scene says and wherever the lengths begin.
TEST_F(IdentifyCommand, TonguesHaveTheModulusOfTheSceneThatAspirateSolves) {
  const std::string scene = std::string(kCells) + "mouse_oocyte_held.yaml";
  const std::string aspirate = "cd " + directory_ + " && " MICROINJECTION_ASPIRATE " --scene " + scene +
                               " --pressures=-500,-1000,-1500,-2500 --tolerance 0.02 --csv tongues.csv 2>/dev/null";
  ASSERT_EQ(std::system(aspirate.c_str()), 0);
  const Outcome outcome =
      CommandTest::run("--tongue tongues.csv --scene " + scene + " --csv found.csv --out fitted.yaml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<double> found = modulus("tongue");
  EXPECT_NEAR(found[0], 17.9e3, 0.01 * 17.9e3);
  EXPECT_LT(found[1], found[0]);
  EXPECT_LT(found[0], found[2]);
  EXPECT_NE(read(directory_ + "fitted.yaml").find("inner_radius"), std::string::npos);
  for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
           {"--tongue tongues.csv", "--tongue: needs --scene"},
           {"--tongue tongues.csv --record x.csv --scene " + scene, "x.csv: cannot be read"},
           {"--tongue tongues.csv --record x.csv --residuals r.csv --scene " + scene,
            "--residuals: must be left out with --tongue"},
           {"--tongue tongues.csv --prony 1 --scene " + scene, "--prony: must be left out with --tongue"},
           {"--tongue tongues.csv --scene " + std::string(kCells) + "mouse_oocyte.yaml",
            "holding_pipette/mouth: is missing"}}) {
    const Outcome refused = CommandTest::run(arguments);
    EXPECT_EQ(refused.status, 2) << arguments;
    EXPECT_NE(refused.err.find(told), std::string::npos) << arguments << '\n' << refused.err;
  }
}

/// What the virtual microscope shows of a mouse's oocyte at the holding pipette of mouse_oocyte_held.yaml, with a
/// tongue of this length (m).
cv::Mat imageOfTongue(Microscope& microscope, double length, std::uint64_t seed) {
  constexpr double kRadius = 28e-6, kZona = 7e-6, kGap = 1e-6;
  HoldingPipette pipette;
  pipette.inner_radius = 10e-6;
  pipette.outer_radius = 41e-6;
  pipette.mouth = std::sqrt(kRadius * kRadius - pipette.inner_radius * pipette.inner_radius) * pipette.axis;
  CellScene cell = CellScene::round({0, 0}, kRadius, kZona, kGap);
  drawIn({pipette.mouth, pipette.axis, pipette.inner_radius, length}, kZona, kGap, cell);
  MicroscopeScene scene;
  scene.cells.push_back(cell);
  scene.holding = pipette;
  return microscope.render(scene, 0, seed);
}

/// What `aspirate` solves, seen by the microscope, has the scene's modulus; what shows no tongue is named and left out.
TEST_F(IdentifyCommand, TonguesAreMeasuredInImages) {
  const std::string scene = std::string(kCells) + "mouse_oocyte_held.yaml";
  const std::string aspirate = "cd " + directory_ + " && " MICROINJECTION_ASPIRATE " --scene " + scene +
                               " --pressures=-1800,-2400,-3000,-3600,-4200,-4800,-5400,-6000 --tolerance 0.02 "
                               "--csv solved.csv 2>/dev/null";
  ASSERT_EQ(std::system(aspirate.c_str()), 0);
  MicroscopeConfig config;
  config.camera.pixel_size = 0.2e-6;
  Microscope microscope(config);
  std::filesystem::create_directories(directory_ + "images");
  std::ofstream table(directory_ + "images/table.csv"), empty(directory_ + "images/empty.csv");
  table << "pressure (Pa),image\n";
  empty << "pressure (Pa),image\n-700,alone.png\n-800,alone.png\n";
  std::istringstream solved(read(directory_ + "solved.csv"));
  std::string line;
  std::getline(solved, line);
  for (int i = 1; std::getline(solved, line); ++i) {
    double pressure = 0, length = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf", &pressure, &length), 2) << line;
    const std::string name = "tongue " + std::to_string(i) + ".png";
    ASSERT_TRUE(cv::imwrite(directory_ + "images/" + name, imageOfTongue(microscope, length, 10 + i)));
    table << pressure << ',' << name << '\n';
  }
  MicroscopeScene alone;
  alone.cells.push_back(CellScene::round({0, 0}, 28e-6, 5e-6, 1e-6));
  ASSERT_TRUE(cv::imwrite(directory_ + "images/alone.png", microscope.render(alone, 0, 1)));
  table << "-4500,alone.png\n-4600,nowhere.png\n";
  table.close();
  empty.close();
  const std::string options = " --pixel-size 0.2e-6 --scene " + scene;
  const Outcome outcome = CommandTest::run("--tongue images/table.csv --csv found.csv" + options);
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  EXPECT_NEAR(modulus("tongue")[0], 17.9e3, 0.1 * 17.9e3) << outcome.out;
  EXPECT_NE(outcome.out.find("; 8 tongues"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("image 'alone.png': tongue not found: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("image 'nowhere.png': tongue not found: "), std::string::npos) << outcome.out;
  for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
           {"--tongue images/empty.csv" + options, "no image shows a tongue surely"},
           {"--tongue solved.csv" + options, "has no column 'image'"},
           {"--tongue images/table.csv --column tongue=image:um" + options, "--column tongue: must be left out"},
           {"--record solved.csv" + options, "--pixel-size: needs --tongue"},
           {"--tongue images/table.csv --vision v.yaml --scene " + scene, "--vision: needs --pixel-size"}}) {
    const Outcome refused = CommandTest::run(arguments);
    EXPECT_EQ(refused.status, 2) << arguments;
    EXPECT_NE(refused.err.find(told), std::string::npos) << arguments << '\n' << refused.err;
  }
}

TEST_F(IdentifyCommand, ARecordIsFittedByTheSolutionOfASceneThatIsInNoFamily) {
  writeLinear(0.1);
  const std::string scene = std::string(kCells) + "mouse_oocyte_linear.yaml";
  const Outcome outcome = run("--record record.csv --no-intervals --model solution --csv found.csv --scene " + scene);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // The paper's linear cell has 5.25 uN at 45 um with 17.9 kPa; see doc/reference/paper.md.
  EXPECT_NEAR(modulus("solution")[0], 0.1 / (5.25e-6 / 45e-6) * 17.9e3, 0.01 * 17.9e3);
}

/// A curve of an exponent between two of those that `identify` solves, with noise.
TEST_F(IdentifyCommand, HowACellStiffensIsFound) {
  writeStiffening("true.yaml", 8);
  writeStiffening("scene.yaml", 4);
  std::string depths = "0.4e-6";
  for (int k = 2; k <= 30; ++k) depths += ',' + std::to_string(0.4 * k) + "e-6";
  const std::string indent = "cd " + directory_ + " && " MICROINJECTION_INDENT " --scene true.yaml --depths " + depths +
                             " --csv solved.csv 2>/dev/null";
  ASSERT_EQ(std::system(indent.c_str()), 0);
  writeApproachAnd("solved.csv", 3e-9);
  const std::string options =
      "--record record.csv --drift off --model solution --free ogden_exponent --csv found.csv --scene scene.yaml";
  const Outcome deep = run(options + " --out fitted.yaml");
  ASSERT_EQ(deep.status, 0) << deep.out << deep.err;
  const std::vector<double> exponent = found("solution", "ogden_exponent");
  EXPECT_NEAR(exponent[0], 8, 0.8);
  EXPECT_LT(exponent[1], 8);
  EXPECT_GT(exponent[2], 8);
  EXPECT_NEAR(modulus("solution")[0], 17.9e3, 0.03 * 17.9e3);
  EXPECT_NE(read(directory_ + "fitted.yaml").find("ogden_exponent: " + std::to_string(exponent[0]).substr(0, 3)),
            std::string::npos);
}

TEST_F(IdentifyCommand, WhatTheSceneCannotFreeIsRefused) {
  writeLinear(0.1);
  writeStiffening("ogden.yaml", 4);
  const std::string zona = " --scene " + std::string(kCells) + "mouse_oocyte_zona.yaml",
                    ogden = " --model solution --scene ogden.yaml", record = "--record record.csv --free ";
  for (const auto& [arguments, told] : std::vector<std::pair<std::string, std::string>>{
           {record + "ogden_exponent --model solution" + zona,
            "--free ogden_exponent: needs a layer of model ogden; the scene has neo_hookean, neo_hookean"},
           {record + "gent_limit" + ogden, "--free gent_limit: needs a layer of model gent; the scene has ogden"},
           {record + "colour" + ogden, "--free colour: must be ogden_exponent or gent_limit, or a ratio with"},
           {record + "ogden_exponent" + zona, "--free ogden_exponent: no family and no formula has it"},
           {record + "ogden_exponent,gent_limit" + ogden, "--free gent_limit: must be left out beside ogden_exponent"},
           {record + "ogden_exponent --tongue t.csv" + ogden, "--free ogden_exponent: must be left out with --tongue"},
           {"--point 3e-6,1e-7 --reading-error 0.05 --free ogden_exponent" + ogden,
            "--free: must be left out with --point"}}) {
    const Outcome refused = run(arguments);
    EXPECT_EQ(refused.status, 2) << arguments;
    EXPECT_NE(refused.err.find(told), std::string::npos) << arguments << '\n' << refused.err;
  }
}

TEST_F(IdentifyCommand, BadPointsAreRefused) {
  const std::string scene = " --model solution --scene " + std::string(kCells) + "mouse_oocyte_pipette.yaml";
  EXPECT_EQ(run("--point 8e-6,1e-6" + scene).status, 2);
  EXPECT_EQ(run("--point 8e-6 --reading-error 0.05" + scene).status, 2);
  EXPECT_EQ(run("--point 8e-6,-1e-6 --reading-error 0.05" + scene).status, 2);
  const Outcome both = run("--record a.csv --point 8e-6,1e-6 --reading-error 0.05" + scene);
  EXPECT_EQ(both.status, 2);
  EXPECT_NE(both.err.find("--record, --tongue or both, or else --point"), std::string::npos) << both.err;
}

TEST_F(IdentifyCommand, OptionsInAnotherUnitAreRefused) {
  const std::string point =
      " --reading-error 0.05 --model solution --scene " + std::string(kCells) + "mouse_oocyte.yaml";
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"--record a.csv --model cone --half-angle 35",
            "--half-angle = 35 rad: must be above 0 and below 1.571 rad; 35 "
            "degrees would be 0.6109"},
           {"--record a.csv --tip-radius 10", "--tip-radius = 10 m: must be 1e-8 .. 1e-3 m; 10 um would be 1e-5"},
           {"--record a.csv --tip-radius -1", "--tip-radius = -1: must be a number > 0"},
           {"--record a.csv --spring-constant 1e5", "--spring-constant = 100000 N/m: must be 1e-6 .. 1e4 N/m"},
           {"--point 8,1e-6" + point, "--point (DEPTH) = 8 m: must be 1e-9 .. 5e-3 m; 8 um would be 8e-6"},
           {"--point 8e-6,2" + point, "--point (FORCE) = 2 N: must be 1e-13 .. 1 N; 2 uN would be 2e-6"},
           {"--point 80e-6,2e-6" + point, "--point (DEPTH) = 8e-05 m: must be 0 .. 5.6e-5 m"},
           {"--point 8e-6,1e-6 --reading-error 5" + point.substr(point.find(" --model")),
            "--reading-error = 5: must be 1e-6 .. 1; 5 % would be 0.05"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
  }
}

TEST_F(IdentifyCommand, TheForceOfATensegrityIsNoSolution) {
  const Outcome outcome = run("--point 8e-6,1e-6 --reading-error 0.05 --model solution --scene " + std::string(kCells) +
                              "mouse_oocyte_tensegrity.yaml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--model solution"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace microinjection
