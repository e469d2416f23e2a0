#include "sensor/force_readout.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr double kTime = 0.1;  // s

class ForceReadoutTest : public ::testing::Test {
 protected:
  /// Lets it read what the sensor says of a force until the average under way is over.
  void readUnder(const Eigen::Vector2d& force) {
    for (int i = 0; i <= 100; ++i) readout.read(rawOf(force), time += 1e-3);
    EXPECT_FALSE(readout.averaging());
  }
  Eigen::Vector2d rawOf(const Eigen::Vector2d& force) const { return sensor * force + offset; }
  double errorUnder(const Eigen::Vector2d& force) { return (readout.read(rawOf(force), time) - force).norm(); }

  ForceReadout readout{2, kTime};
  Eigen::Matrix2d sensor = (Eigen::Matrix2d() << 1.1, 0.05, -0.03, 0.8).finished();
  Eigen::Vector2d offset{3e-6, -5e-6};  // N
  double time = 100;
};

TEST_F(ForceReadoutTest, BeginsWithTheRawReading) {
  EXPECT_EQ(readout.read(Eigen::Vector2d(1e-6, 2e-6), 0), Eigen::Vector2d(1e-6, 2e-6));
}

TEST_F(ForceReadoutTest, TareIsTheMeanOverItsTime) {
  EXPECT_EQ(readout.beginTare(), "");
  EXPECT_EQ(readout.beginTare(), "an average is under way");
  for (int i = 0; i <= 100; ++i) {
    EXPECT_TRUE(readout.averaging()) << i;
    readout.read(offset + Eigen::Vector2d((i - 50) * 1e-8, 0), 5 + i * 1e-3 + (i == 100 ? 1e-9 : 0));
  }
  EXPECT_FALSE(readout.averaging());
  EXPECT_NEAR((readout.tare() - offset).norm(), 0, 1e-15);
  EXPECT_NEAR(readout.read(offset, 6).norm(), 0, 1e-15);
}

TEST_F(ForceReadoutTest, AnInterruptedTareChangesNothing) {
  readout.beginTare();
  readout.read(offset, 0);
  readout.interrupt();
  readout.read(offset, 1);
  EXPECT_EQ(readout.tare(), Eigen::Vector2d(0, 0));
  EXPECT_NE(readout.outcome().find("given up"), std::string::npos);
}

TEST_F(ForceReadoutTest, PointsThatSpanBothAxesUndoTheCoupling) {
  readout.beginTare();
  readUnder({0, 0});
  const Eigen::Vector2d forces[] = {{50e-6, 0}, {0, 50e-6}, {30e-6, -20e-6}};
  for (const auto& force : forces) {
    EXPECT_EQ(readout.beginPoint(force), "");
    readUnder(force);
  }
  EXPECT_EQ(readout.points(), 3);
  EXPECT_GT(errorUnder({10e-6, 20e-6}), 1e-6);
  EXPECT_EQ(readout.solve(), "");
  EXPECT_LT(errorUnder({10e-6, 20e-6}), 1e-15);
  EXPECT_LT(readout.residual(), 1e-15);
  readout.clear();
  EXPECT_TRUE(readout.gain().isIdentity());
}

TEST_F(ForceReadoutTest, OneForceCalibratesItsAxisOnly) {
  readout.beginTare();
  readUnder({0, 0});
  readout.beginPoint(Eigen::Vector2d(50e-6, 0));
  readUnder({50e-6, 0});
  EXPECT_EQ(readout.solve(), "");
  EXPECT_NEAR(readout.gain()(0, 0), 1 / 1.1, 1e-12);
  EXPECT_EQ(readout.gain()(1, 1), 1);
  EXPECT_EQ(readout.gain()(0, 1), 0);
}

TEST_F(ForceReadoutTest, InconsistentPointsShowInTheResidual) {
  sensor.setIdentity();
  offset.setZero();
  const Eigen::Vector2d forces[] = {{50e-6, 0}, {0, 50e-6}};
  for (const double error : {-1e-6, 1e-6}) {
    for (const auto& force : forces) {
      readout.beginPoint(force);
      readUnder(force + Eigen::Vector2d(error, 0));
    }
  }
  EXPECT_EQ(readout.solve(), "");
  EXPECT_NEAR(readout.residual(), 1e-6 / std::sqrt(2), 0.1e-6);
}

TEST_F(ForceReadoutTest, RefusesWhatCannotBeCalibrated) {
  EXPECT_EQ(readout.solve(), "there is no calibration point");
  EXPECT_NE(readout.beginPoint(Eigen::Vector2d(0, 0)), "");
  EXPECT_NE(readout.beginPoint(Eigen::Vector2d(NAN, 0)), "");
  sensor << 1, 1, 1, 1;  // both axes feel the same
  const Eigen::Vector2d forces[] = {{50e-6, 0}, {0, 50e-6}};
  for (const auto& force : forces) {
    readout.beginPoint(force);
    readUnder(force);
  }
  sensor.setZero();
  EXPECT_EQ(readout.solve(), "the readings do not tell the known forces apart");
  EXPECT_TRUE(readout.gain().isIdentity());
}

}  // namespace
}  // namespace microinjection
