#include <gtest/gtest.h>

#include <cmath>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "sensor_bench.h"

namespace microinjection {
namespace {

constexpr double kLateralNoise = 240e-9;  // N rms

class ForceSensorNodeTest : public testing::Test {
 protected:
  std::string status() { return bench_.session.diagnostics().text(kSensorStatus); }
  int level() { return bench_.session.diagnostics().of(kSensorStatus)->level; }

  SensorBench bench_;
};

TEST_F(ForceSensorNodeTest, ItsAxesTurnWithThePipette) {
  constexpr double kTilt = M_PI / 6;
  bench_.needle.pose.orientation.y = std::sin(kTilt / 2);
  bench_.needle.pose.orientation.w = std::cos(kTilt / 2);
  bench_.load(0, 0, 100e-6, 0.1);
  const auto& reading = *bench_.measured.newest();
  EXPECT_EQ(reading.header.frame_id, "needle_tip");
  const double axial = 100e-6 * std::cos(kTilt), lateral = -100e-6 * std::sin(kTilt);  // N
  constexpr double kCross = 0.02;  // share of the cross-axis sensitivity
  EXPECT_NEAR(reading.wrench.force.x, lateral + kCross * axial, 6 * kLateralNoise);
  EXPECT_EQ(reading.wrench.force.y, 0);
  EXPECT_NEAR(reading.wrench.force.z, axial + kCross * lateral, 100e-9);
}

TEST_F(ForceSensorNodeTest, WhatItCannotTrustHasNoReading) {
  const std::optional<SensorBench::Wrench> untrusted[] = {std::nullopt, wrenchMessage(0, 0, NAN),
                                                          wrenchMessage(0, 0, 1e-6, "camera")};
  for (const auto& bad : untrusted) {
    SCOPED_TRACE(bad ? bad->header.frame_id : "silence");
    bench_.load(0, 0, 1e-6, 0.1);
    EXPECT_TRUE(bench_.valid());
    bench_.force = bad;
    bench_.session.run(0.3);
    EXPECT_FALSE(bench_.valid());
    EXPECT_NE(level(), 0);
    EXPECT_EQ(status(), "no valid force");
  }
  bench_.load(0, 0, 1e-6, 0.01);
  bench_.needle = poseMessage(0, 0, NAN);
  bench_.session.run(0.3);
  EXPECT_FALSE(bench_.valid());
  EXPECT_EQ(status(), "no valid needle pose");
}

/// The force guard takes what is measured.
TEST_F(ForceSensorNodeTest, InContactNeitherTareNorGainMovesTheForce) {
  const auto lead = [&](const std::string& injection) {
    cell_microinjection::OperatingState operating;
    operating.state = "ENABLED";
    bench_.session.world().sayNow("controller/operating_state", operating);
    cell_microinjection::InjectionStatus status;
    status.state = injection;
    bench_.session.world().sayNow("controller/injection_state", status);
    bench_.session.run(0.02);
  };
  bench_.load(0, 0, 10e-6, 0.02);
  lead("indent");
  const auto refused = bench_.trigger("tare");
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("led in contact"), std::string::npos) << refused.message;
  EXPECT_FALSE(bench_.calibrate(SensorBench::Calibrate::Request::CLEAR).success);
  lead("idle");
  EXPECT_TRUE(bench_.trigger("tare").success);
  bench_.session.run(0.1);
  lead("indent");  // an average that has begun does not end either
  bench_.session.run(0.6);
  EXPECT_NEAR(bench_.mean(bench_.measured)[1], 10e-6, 100e-9);
}

TEST_F(ForceSensorNodeTest, AnOverloadIsAFaultUntilReset) {
  bench_.load(0, 0, 1e-3, 0.02);  // beyond the range, not yet the overload
  EXPECT_TRUE(bench_.valid());
  bench_.load(0, 0, 3e-3, 0.02);
  EXPECT_FALSE(bench_.valid());
  bench_.load(0, 0, 0, 0.3);
  EXPECT_FALSE(bench_.valid());
  EXPECT_EQ(level(), 2);
  EXPECT_EQ(status().find("overloaded: 0.003"), 0U) << status();
  EXPECT_NE(status().find(" times axial_overload = 0.002 N; call the service ~reset"), std::string::npos) << status();
  EXPECT_FALSE(bench_.trigger("tare").success);
  EXPECT_TRUE(bench_.trigger("reset").success);
  bench_.session.run(0.02);
  EXPECT_TRUE(bench_.valid());
}

}  // namespace
}  // namespace microinjection
