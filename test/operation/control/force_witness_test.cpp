#include "operation/control/force_witness.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace microinjection {
namespace {

constexpr double kSpeed = 100e-6, kPeriod = 1e-3, kStiffness = 0.1;  // m/s, s, N/m
constexpr int kRest = 400, kDescent = 300;                           // steps
constexpr int kTouch = 450;                                          // step

/// A needle that goes down on a spring, felt by a prediction and by a sensor with noise.
class ForceWitnessTest : public testing::Test {
 protected:
  /// What the sensor says in a step of what it feels (N), from the touch on; empty: no new reading.
  using Sensor = std::function<std::optional<double>(int step, double felt)>;

  /// @param measured  the witness is the sensor; else the prediction is
  std::string disagreement(bool measured, const Sensor& sensor) {
    WitnessConfig config;
    config.measured = measured;
    NeedleMonitor acting{DetectionConfig()};
    ForceWitness witness(DetectionConfig(), config);
    Eigen::Vector3d told = Eigen::Vector3d::Zero();
    std::string found;
    for (int step = 0; step < kRest + kDescent && found.empty(); ++step) {
      const double depth = kSpeed * kPeriod * std::max(0, step - kTouch);
      const Eigen::Vector3d tip(0, 0, 20e-6 - kSpeed * kPeriod * std::max(0, step - kRest));
      const Eigen::Vector3d predicted(0, 0, kStiffness * depth);
      const double noise = noise_(random_);
      const std::optional<double> reading = step < kTouch ? predicted.z() + noise : sensor(step, predicted.z() + noise);
      if (reading) told.z() = *reading;
      const bool is_new = reading.has_value();
      const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
      witness.step(tip, axis, measured ? told : predicted, measured ? is_new : true);
      const bool acting_is_new = measured || is_new;
      const Eigen::Vector3d& force = measured ? predicted : told;
      acting_is_new ? acting.step(tip, axis, force) : acting.move(tip, axis);
      witness.compare(acting, force, acting_is_new);
      found = witness.disagreement();
    }
    return found;
  }

  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, 20e-9};  // N
};

TEST_F(ForceWitnessTest, ASensorThatFeelsTheSameAgrees) {
  for (const bool measured : {true, false})
    EXPECT_EQ(disagreement(measured, [](int, double felt) { return felt; }), "");
}

/// The machine holds the sensor's node up for 0.15 s, in which the needle goes 15 um deeper.
TEST_F(ForceWitnessTest, ALateSensorIsComparedWithWhatTheOtherOneFeltThen) {
  for (const bool measured : {true, false}) {
    for (const int begin : {kTouch - 20, kTouch + 1, kTouch + 10, kTouch + 60}) {
      const auto late = [begin](int step, double felt) {
        return step >= begin && step < begin + 150 ? std::nullopt : std::optional<double>(felt);
      };
      EXPECT_EQ(disagreement(measured, late), "") << measured << ' ' << begin;
    }
  }
}

TEST_F(ForceWitnessTest, ADeadSensorDisagrees) {
  const std::string dead = disagreement(true, [this](int, double) { return noise_(random_); });
  EXPECT_NE(dead.find("the prediction has felt a touch"), std::string::npos) << dead;
}

TEST_F(ForceWitnessTest, ASensorOfTenTimesLessDisagrees) {
  for (const bool measured : {true, false}) {
    const std::string less = disagreement(measured, [](int, double felt) { return felt / 10; });
    EXPECT_NE(less.find("allowed is a ratio of witness/ratio = 5"), std::string::npos) << measured << less;
  }
}

TEST_F(ForceWitnessTest, ASensorThatReadsSlowlyIsComparedToo) {
  const auto slow = [this](int step, double) {
    return step % 20 == 0 ? std::optional<double>(noise_(random_)) : std::nullopt;
  };
  EXPECT_NE(disagreement(true, slow), "");
}

}  // namespace
}  // namespace microinjection
