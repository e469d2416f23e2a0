#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "sensor_bench.h"

namespace microinjection {
namespace {

using Action = SensorBench::Calibrate::Request;

std::vector<double> listOf(const YAML::Node& node) { return node.as<std::vector<double>>(); }

TEST(ForceSensorCalibration, TareAndGainAreFoundKeptAndUndone) {
  SensorBench bench;
  bench.load(30e-6, 0, 50e-6, 0.02);  // something hangs on the sensor
  bench.tare();
  EXPECT_LT(bench.mean(bench.measured).cwiseAbs().maxCoeff(), 100e-9);
  EXPECT_GT(bench.mean(bench.raw)[1], 49e-6);  // raw stays raw
  for (const auto& [lateral, axial] : {std::pair(100e-6, 0.0), {0.0, 100e-6}}) {
    bench.load(30e-6 + lateral, 0, 50e-6 + axial, 0.02);
    EXPECT_TRUE(bench.calibrate(Action::ADD, lateral, axial).success);
    bench.session.run(0.6);
  }
  const auto answer = bench.calibrate(Action::SOLVE);
  ASSERT_TRUE(answer.success) << answer.message;
  const double determinant = 1 - 0.02 * 0.02;  // of the sensitivity [1, 0.02; 0.02, 1]
  const double gain[] = {1 / determinant, -0.02 / determinant, -0.02 / determinant, 1 / determinant};
  ASSERT_EQ(answer.gain.size(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(answer.gain[i], gain[i], 0.003) << i;
  bench.load(110e-6, 0, 10e-6, 0);
  EXPECT_LT((bench.mean(bench.measured) - Eigen::Vector2d(80e-6, -40e-6)).cwiseAbs().maxCoeff(), 300e-9);

  const YAML::Node file = YAML::LoadFile(bench.path);
  EXPECT_EQ(listOf(file["gain"]), answer.gain);
  EXPECT_EQ(file["residual"].as<double>(), answer.residual);
  EXPECT_EQ(file["points"].as<int>(), 2);
  const std::vector<double> tare = listOf(file["tare"]);
  ASSERT_EQ(tare.size(), 2U);
  EXPECT_NEAR(tare[0], 50e-6 + 0.02 * 30e-6, 0.2e-6);
  EXPECT_NEAR(tare[1], 30e-6 + 0.02 * 50e-6, 0.2e-6);

  EXPECT_EQ(bench.calibrate(Action::UNDO).gain, (std::vector<double>{1, 0, 0, 1}));
  const auto again = bench.calibrate(Action::SOLVE);
  EXPECT_EQ(again.gain, answer.gain);
  EXPECT_EQ(again.residual, answer.residual);
  EXPECT_EQ(again.points, 2U);
  EXPECT_FALSE(bench.calibrate(7).success);
  EXPECT_TRUE(bench.calibrate(Action::CLEAR).success);
  EXPECT_EQ(bench.calibrate(Action::UNDO).gain, answer.gain);
}

TEST(ForceSensorCalibration, ARestartedNodeHasTheTareOfItsFile) {
  SensorBench bench;
  bench.load(0, 0, 50e-6, 0.02);
  bench.tare();
  ASSERT_TRUE(std::filesystem::exists(bench.path));
  bench.session.executive().restart("force_sensor");
  bench.session.run(0.02);
  EXPECT_LT(bench.mean(bench.measured).cwiseAbs().maxCoeff(), 100e-9);
}

/// The operator waits for it, and not for the next of the reports that come once a second.
TEST(ForceSensorCalibration, AnAverageIsReportedWhenItEnds) {
  SensorBench bench(1);
  const auto& diagnostics = bench.session.world().hear<diagnostic_msgs::DiagnosticArray>("/diagnostics");
  const ros::Time asked = bench.session.now();
  EXPECT_TRUE(bench.trigger("tare").success);
  bench.session.run(0.8);
  std::vector<std::pair<double, std::string>> outcomes;  // s since it was asked, what is new
  for (const auto& message : diagnostics.all()) {
    for (const auto& status : message->status) {
      if (status.name != kSensorStatus) continue;
      for (const auto& value : status.values) {
        const bool is_new = outcomes.empty() || value.value != outcomes.back().second;
        if (value.key == "tare and calibration" && is_new)
          outcomes.emplace_back(secondsBetween(asked, message->header.stamp), value.value);
      }
    }
  }
  ASSERT_EQ(outcomes.size(), 2U);
  EXPECT_EQ(outcomes[0].second, "taring");
  EXPECT_EQ(outcomes[1].second.substr(0, 5), "tared");
  EXPECT_LE(outcomes[0].first, 0.0021);
  EXPECT_NEAR(outcomes[1].first - outcomes[0].first, 0.5, 0.003);
}

TEST(ForceSensorCalibration, WhatNoSensorNeedsIsRefused) {
  SensorBench bench;
  struct Known {
    double lateral, axial;  // N
    std::string why;
  };
  for (const Known& known : {Known{0, 1e300, "the known axial force = 1e+300 N, allowed [-0.00049, 0.00049] N"},
                             {1e-3, 0, "the known lateral force = 0.001 N, allowed [-0.0009, 0.0009] N"},
                             {0, NAN, "the known force is not finite"},
                             {0, 0, "the known force is zero"}}) {
    const auto answer = bench.calibrate(Action::ADD, known.lateral, known.axial);
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find(known.why), std::string::npos) << answer.message;
  }
  // A force is announced that is not there.
  EXPECT_TRUE(bench.calibrate(Action::ADD, 0, 400e-6).success);
  bench.session.run(0.6);
  const auto answer = bench.calibrate(Action::SOLVE);
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("the gain that fits the points changes forces by factors"), std::string::npos)
      << answer.message;
  EXPECT_EQ(answer.gain, (std::vector<double>{1, 0, 0, 1}));
}

}  // namespace
}  // namespace microinjection
