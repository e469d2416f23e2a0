// Parameters of the cell change under a pressed needle: the force follows without a jump, /cell/state says which
// parameters are felt, and what is wrong changes nothing.

#include <gtest/gtest.h>

#include <algorithm>

#include "cell_microinjection/CellParameters.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/SetCellParameters.h"
#include "scripted_needle.h"

namespace microinjection {
namespace {

constexpr double kSceneModulus = 17.9e3, kSceneDiameter = 56e-6;  // Pa, m, of the scene
constexpr double kPressedDepth = 8e-6;                            // m, in which the zona holds
constexpr double kChangeTime = 0.02, kRiseTime = 0.03;            // s, of another member; of 0.3 um
using Names = std::vector<std::string>;
using Values = std::vector<double>;

class ChangeCellTest : public testing::Test {
 protected:
  ChangeCellTest() {
    session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf");
    session_.world().hear<cell_microinjection::CellState>("cell/state");
    session_.add("cell_simulator", "{needle: measured, diagnostic_period: 0.1}");
    session_.run(0.05);
    needle_.z = heightOf(0);
    needle_.moveTo(heightOf(kPressedDepth), 80e-6);
    session_.run(0.05);
    EXPECT_GT(predicted(), 0.2e-6);
  }

  static double heightOf(double depth) { return 0.5 * kSceneDiameter - depth; }
  double predicted() {
    const auto& message = *session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf").newest();
    EXPECT_FALSE(message.header.stamp.isZero());
    return message.wrench.force.z;
  }
  /// A parameter of the cell whose force is felt.
  double felt(const std::string& name) {
    const auto& state = *session_.world().hear<cell_microinjection::CellState>("cell/state").newest();
    const auto& names = state.parameter_names;
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? NAN : state.parameter_values.at(found - names.begin());
  }
  cell_microinjection::SetCellParameters::Response change(const Names& names, const Values& values) {
    cell_microinjection::SetCellParameters::Request request;
    request.name = names;
    request.value = values;
    return session_.call<cell_microinjection::SetCellParameters>("cell_simulator/set_cell_parameters", request);
  }
  void changeByTopic(const std::string& name, double value) {
    cell_microinjection::CellParameters message;
    message.name = {name};
    message.value = {value};
    session_.world().say("cell/set_parameters", message);
  }
  /// N, that the published force may be off.
  double forceError() {
    return session_.world().hear<cell_microinjection::CellState>("cell/state").newest()->force_error;
  }
  /// The force changes for `duration` (s), by no more than an eighth of the change in 1 ms.
  void expectSteadyChange(double duration) {
    const double before = predicted();
    std::vector<double> forces{before};
    for (int i = 0; i < 60; ++i) {
      session_.run(1e-3);
      forces.push_back(predicted());
    }
    double largest = 0;
    for (std::size_t i = 1; i < forces.size(); ++i) largest = std::max(largest, std::abs(forces[i] - forces[i - 1]));
    EXPECT_LT(largest, std::abs(forces.back() - before) / 8 + 1e-12);
    EXPECT_EQ(forces.back(), forces[static_cast<std::size_t>(1e3 * duration) + 3]);
  }

  VirtualSession session_{{"cell:=mouse_oocyte_injection"}};
  ScriptedNeedle needle_{session_, heightOf(-5e-6)};
};

TEST_F(ChangeCellTest, AnotherModulusIsFelt) {
  const double before = predicted();
  const auto answer = change({"young_modulus"}, {15e3});
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_NE(answer.message.find("family homogeneous"), std::string::npos) << answer.message;
  expectSteadyChange(kChangeTime);
  EXPECT_NEAR(predicted() / before, 15 / 17.9, 1e-3);
  EXPECT_EQ(felt("young_modulus"), 15e3);
}

TEST_F(ChangeCellTest, TheErrorIsThatOfTheFeltForce) {
  EXPECT_GT(forceError(), 0);
  EXPECT_LT(forceError(), 0.03 * predicted());
  EXPECT_TRUE(change({"young_modulus"}, {20e3}).success);
  session_.run(0.1);
  EXPECT_LT(forceError(), 0.03 * predicted());
  needle_.jumpTo(heightOf(-20e-6), 0.1);
  EXPECT_EQ(forceError(), 0) << "nothing touches";
}

TEST_F(ChangeCellTest, AMessageChangesItToo) {
  const double before = predicted();
  changeByTopic("young_modulus", 20e3);
  session_.run(0.03);
  EXPECT_NEAR(predicted() / before, 20 / 17.9, 1e-3);
  session_.run(0.03);
  EXPECT_EQ(felt("young_modulus"), 20e3);
}

TEST_F(ChangeCellTest, AnotherDiameterKeepsTheContact) {
  const double before = predicted();
  const auto answer = change({"diameter"}, {62e-6});
  EXPECT_TRUE(answer.success) << answer.message;
  expectSteadyChange(kChangeTime);
  EXPECT_NEAR(predicted() / before, 1, 0.2) << "the same depth in a cell that is a little larger";
  EXPECT_EQ(felt("diameter"), 62e-6);
  needle_.jumpTo(heightOf(-20e-6), 0.05);
  EXPECT_EQ(predicted(), 0);
  needle_.jumpTo(heightOf(-1e-6), 0.02);  // below the surface that the larger cell has now
  EXPECT_GT(predicted(), 10e-9);
}

TEST_F(ChangeCellTest, AnotherHeightIsAnotherDepth) {
  const double before = predicted();
  EXPECT_TRUE(change({"height"}, {0.3e-6}).success);
  expectSteadyChange(kRiseTime);
  EXPECT_EQ(felt("height"), 0.3e-6);
  const double higher = predicted();
  EXPECT_GT(higher, 1.01 * before);
  EXPECT_TRUE(change({"height"}, {0}).success);
  expectSteadyChange(kRiseTime);
  EXPECT_NEAR(predicted() / before, 1, 1e-6);
  needle_.jumpTo(heightOf(kPressedDepth + 0.3e-6), 0.02);
  EXPECT_NEAR(predicted() / higher, 1, 1e-3);
}

TEST_F(ChangeCellTest, WhatIsWrongChangesNothing) {
  struct Case {
    Names names;
    Values values;
    const char* reason;
  };
  const double before = predicted();
  for (const Case& wrong :
       {Case{{"young_modulus"}, {0}, "young_modulus = 0: must be"},
        Case{{"young_modulus"}, {NAN}, "young_modulus = nan: must be"},
        Case{{"diameter"}, {-INFINITY}, "diameter = -inf: must be"},
        Case{{"poisson_ratio"}, {0.3}, "outside of family homogeneous: "},
        Case{{"diameter"}, {150e-6}, "outside of family homogeneous: "},
        Case{{"core_modulus"}, {1e3}, "core_modulus: is no parameter of this cell; these are: "},
        Case{{"height"}, {NAN}, "height = nan m: must be within"},
        Case{{"young_modulus", "height"}, {15e3, 20e-6}, "height = 2e-05 m: must be within"},
        Case{{"young_modulus"}, {}, "must have one for each of the 1 names"}, Case{{}, {}, "must have at least one"}}) {
    const auto answer = change(wrong.names, wrong.values);
    EXPECT_FALSE(answer.success) << wrong.reason;
    EXPECT_NE(answer.message.find(wrong.reason), std::string::npos) << answer.message;
    session_.run(0.06);
    EXPECT_EQ(predicted(), before) << wrong.reason;
  }
  EXPECT_EQ(felt("young_modulus"), kSceneModulus);
  EXPECT_EQ(felt("height"), 0);
}

TEST_F(ChangeCellTest, AMessageThatIsWrongIsReported) {
  const double before = predicted();
  changeByTopic("young_modulus", INFINITY);
  session_.run(0.2);
  EXPECT_TRUE(session_.diagnostics().ever("cell_simulator: inputs", "cell/set_parameters: refused"));
  EXPECT_EQ(predicted(), before);
}

}  // namespace
}  // namespace microinjection
