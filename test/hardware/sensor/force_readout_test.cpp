#include "hardware/sensor/force_readout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace microinjection {
namespace {

constexpr double kTime = 0.1;                  // s
const Eigen::Vector2d kRange(490e-6, 900e-6);  // N

class ForceReadoutTest : public ::testing::Test {
 protected:
  /// Lets it read what the sensor says of a force until the average under way is over.
  void readUnder(const Eigen::Vector2d& force) {
    for (int i = 0; i <= 100; ++i) readout.read(rawOf(force), time += 1e-3);
    EXPECT_FALSE(readout.averaging());
  }
  Eigen::Vector2d rawOf(const Eigen::Vector2d& force) const { return sensor * force + offset; }
  double errorUnder(const Eigen::Vector2d& force) { return (readout.read(rawOf(force), time) - force).norm(); }

  ForceReadout readout{kRange, kTime};
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
  readout.interrupt("not every reading was valid");
  readout.read(offset, 1);
  EXPECT_EQ(readout.tare(), Eigen::Vector2d(0, 0));
  EXPECT_NE(readout.outcome().find("aborted"), std::string::npos);
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
  EXPECT_EQ(readout.solve(), "the readings do not distinguish the known forces");
  EXPECT_TRUE(readout.gain().isIdentity());
}

TEST_F(ForceReadoutTest, KnownForcesThatTheSensorCannotFeelAreRefusedByName) {
  EXPECT_EQ(readout.beginPoint(Eigen::Vector2d(500e-6, 0)),
            "the known axial force = 0.0005 N, allowed [-0.00049, 0.00049] N");
  EXPECT_EQ(readout.beginPoint(Eigen::Vector2d(0, -1e300)),
            "the known lateral force = -1e+300 N, allowed [-0.0009, 0.0009] N");
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)})
    EXPECT_EQ(readout.beginPoint(Eigen::Vector2d(0, bad)), "the known force is not finite");
  EXPECT_FALSE(readout.averaging());
  EXPECT_EQ(readout.beginPoint(kRange), "");
}

/// The known force is a hundredth of a percent of what acts, or the sensor does not feel it at all.
TEST_F(ForceReadoutTest, AGainThatNoSensorHasIsRefusedAndTheOldOneStays) {
  sensor.setIdentity();
  offset.setZero();
  readout.beginPoint(Eigen::Vector2d(50e-6, 0));
  readUnder({40e-6, 0});
  ASSERT_EQ(readout.solve(), "");
  const Eigen::MatrixXd before = readout.gain();
  ASSERT_NEAR(before(0, 0), 1.25, 1e-12);
  const double residual = readout.residual();
  struct Case {
    Eigen::Vector2d known, felt;
  };
  const Case cases[] = {{{1e-300, 0}, {50e-6, 0}}, {{1e-9, 0}, {50e-6, 0}}, {{400e-6, 0}, {1e-9, 0}}};
  for (const Case& wrong : cases) {
    ForceReadout fresh(kRange, kTime);
    readout = fresh;
    readout.beginPoint(Eigen::Vector2d(50e-6, 0));
    readUnder({40e-6, 0});
    ASSERT_EQ(readout.solve(), "");
    for (int i = 0; i < 50; ++i) {
      readout.beginPoint(wrong.known);
      readUnder(wrong.felt);
    }
    EXPECT_NE(readout.solve(), "") << wrong.known.transpose();
    EXPECT_EQ(readout.gain(), before);
    EXPECT_EQ(readout.residual(), residual);
  }
}

TEST_F(ForceReadoutTest, PointsThatDoNotFitEachOtherAreRefused) {
  sensor.setIdentity();
  offset.setZero();
  for (const double sign : {1.0, -1.0, 1.0}) {
    readout.beginPoint(Eigen::Vector2d(50e-6, 0));
    readUnder({sign * 50e-6, 0});
    readout.beginPoint(Eigen::Vector2d(0, 50e-6));
    readUnder({0, 50e-6});
  }
  const std::string refusal = readout.solve();
  EXPECT_EQ(refusal.rfind("the points differ from the fit by ", 0), 0u) << refusal;
  EXPECT_TRUE(readout.gain().isIdentity());
}

/// Turned into the sensor's frame, a force along one axis leaves the rounding of the other.
TEST_F(ForceReadoutTest, RoundingIsNoForce) {
  readout.beginTare();
  readUnder({0, 0});
  readout.beginPoint(Eigen::Vector2d(50e-6, 1e-21));
  readUnder({50e-6, 0});
  EXPECT_EQ(readout.solve(), "");
  EXPECT_EQ(readout.gain()(1, 1), 1);
}

TEST_F(ForceReadoutTest, WhatIsNotFiniteIsNeitherTareNorPoint) {
  const double huge = std::numeric_limits<double>::max();
  readout.beginTare();
  for (int i = 0; i <= 100; ++i) readout.read(Eigen::Vector2d(huge, 0), time += 1e-3);
  EXPECT_EQ(readout.tare(), Eigen::Vector2d(0, 0));
  EXPECT_NE(readout.outcome().find("aborted"), std::string::npos);
}

TEST_F(ForceReadoutTest, ReportsTheNoiseOfAnAverage) {
  readout.beginTare();
  // A square wave of 1 nN and 3 nN about the offset has these as its rms.
  for (int i = 0; i <= 100; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    readout.read(offset + side * Eigen::Vector2d(1e-9, 3e-9), time += 1e-3);
  }
  EXPECT_NEAR(readout.noise()[0], 1e-9, 1e-11);
  EXPECT_NEAR(readout.noise()[1], 3e-9, 3e-11);
  EXPECT_NE(readout.outcome().find("noise"), std::string::npos);
}

TEST_F(ForceReadoutTest, EachStepIsTakenBackInTurn) {
  EXPECT_EQ(readout.undo(), "there is no step of this session to take back");
  readout.beginTare();
  EXPECT_EQ(readout.undo(), "an average is under way");
  readUnder({0, 0});
  for (const double wrong : {1.0, 3.0}) {
    readout.beginPoint(Eigen::Vector2d(50e-6 * wrong, 0));  // the second one is not the force that acts
    readUnder({50e-6, 0});
  }
  EXPECT_EQ(readout.undo(), "");
  EXPECT_EQ(readout.points(), 1);
  EXPECT_EQ(readout.solve(), "");
  EXPECT_NEAR(readout.gain()(0, 0), 1 / 1.1, 1e-12);
  EXPECT_EQ(readout.calibration().points, 1);
  EXPECT_EQ(readout.undo(), "");
  EXPECT_TRUE(readout.gain().isIdentity());
  EXPECT_EQ(readout.calibration().points, 0);
  EXPECT_EQ(readout.undo(), "");
  EXPECT_EQ(readout.points(), 0);
  EXPECT_NE(readout.tare(), Eigen::Vector2d(0, 0));
  EXPECT_EQ(readout.undo(), "");
  EXPECT_EQ(readout.tare(), Eigen::Vector2d(0, 0));
}

TEST_F(ForceReadoutTest, CountsTheChangesOfTareAndGainOnly) {
  readout.beginTare();
  readUnder({0, 0});
  EXPECT_EQ(readout.changes(), 1u);
  readout.beginPoint(Eigen::Vector2d(50e-6, 0));
  readUnder({50e-6, 0});
  EXPECT_EQ(readout.changes(), 1u);
  readout.undo();
  EXPECT_EQ(readout.changes(), 1u);
  readout.undo();
  EXPECT_EQ(readout.changes(), 2u);
}

TEST_F(ForceReadoutTest, ARestoredCalibrationMeasuresTheSame) {
  readout.beginTare();
  readUnder({0, 0});
  readout.beginPoint(Eigen::Vector2d(50e-6, 0));
  readUnder({50e-6, 0});
  ASSERT_EQ(readout.solve(), "");
  ForceReadout next{kRange, kTime};
  next.restore(readout.calibration());
  EXPECT_EQ(next.changes(), 0u);
  const Eigen::Vector2d raw = rawOf({7e-6, 2e-6});
  EXPECT_EQ(next.read(raw, 0), readout.read(raw, time));
}

}  // namespace
}  // namespace microinjection
