#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>
#include <utility>

#include "operation/control/contact_detector.h"
#include "operation/control/force_noise.h"
#include "operation/control/needle_monitor.h"
#include "operation/control/puncture_detector.h"

namespace microinjection {
namespace {

constexpr double kNoise = 10e-9;   // N rms
constexpr double kOffset = 35e-9;  // N
constexpr double kChange = 50e-9;  // N, that leaves the rest
constexpr int kMillion = 1000000;

class DetectorsTest : public testing::Test {
 protected:
  explicit DetectorsTest(int samples = 200000) : noise_(samples, 1e-12, kChange) {
    while (!noise_.ready()) noise_.add(sample());
  }
  double sample(double force = 0) { return kOffset + force + kNoise * deviate_(random_); }

  double above(double force = 0) { return sample(force) - kOffset; }

  std::mt19937 random_{7};
  std::normal_distribution<double> deviate_{0, 1};
  ForceNoise noise_;
};

TEST_F(DetectorsTest, NoiseAtRestIsMeasured) {
  EXPECT_NEAR(noise_.offset(), kOffset, 0.01 * kNoise);
  EXPECT_NEAR(noise_.deviation(), kNoise, 0.01 * kNoise);
  ForceNoise few(100, 1e-12, kChange), silent(100, 3e-9, kChange);
  for (int i = 0; i < 100; ++i) few.add(sample()), silent.add(kOffset);
  EXPECT_GT(few.deviation(), 0.95 * kNoise) << "on the safe side";
  EXPECT_EQ(silent.deviation(), 3e-9);
}

TEST_F(DetectorsTest, AForceThatRisesEndsTheMeasurementAtRest) {
  ForceNoise pushed(300, 5e-9, kChange);
  for (int i = 0; i < 100; ++i) pushed.add(sample());
  pushed.add(sample(80e-9));  // a spike
  for (int i = 0; i < 10; ++i) pushed.add(sample());
  EXPECT_FALSE(pushed.ready());
  int steps = 0;
  while (!pushed.ready()) pushed.add(sample(2e-9 * ++steps));  // 20 um/s into 0.1 N/m
  EXPECT_LT(steps, 80);
  EXPECT_NEAR(pushed.offset(), kOffset, 0.1 * kChange);
  EXPECT_NEAR(pushed.deviation(), kNoise, 0.7 * kNoise);
}

/// A force that rises at once leaves 20 samples of rest: the error of their mean is no contact.
TEST_F(DetectorsTest, AShortMeasurementAtRestCausesNoFalseContact) {
  int alarms = 0;
  for (int run = 0; run < 100; ++run) {
    ForceNoise brief(20, 1e-12, kChange);
    while (!brief.ready()) brief.add(sample());
    ContactDetector detector(brief, 1e-9, 1e-7);
    bool alarm = false;
    for (int i = 0; i < 1000 && !alarm; ++i) alarm = detector.step(sample());
    alarms += static_cast<int>(alarm);
  }
  EXPECT_LE(alarms, 1);
}

TEST(NormalQuantile, KnownValues) {
  EXPECT_NEAR(normalQuantile(0.05), 1.6448536, 1e-6);
  EXPECT_NEAR(normalQuantile(1e-3), 3.0902323, 1e-6);
  EXPECT_NEAR(normalQuantile(1e-9), 5.9978070, 1e-6);
}

TEST_F(DetectorsTest, ContactAlarmsFalselyAsOftenAsDesigned) {
  for (const double force : {5e-9, 10e-9, 20e-9, 50e-9}) {
    ContactDetector detector(noise_, force, 1e-4);
    int alarms = 0;
    for (int i = 0; i < kMillion; ++i) {
      if (!detector.step(sample())) continue;
      ++alarms;
      detector.reset();
    }
    // 100 are expected, with a deviation of 10; never more than by chance, and the test is not blunter than it says.
    EXPECT_LT(alarms, 130) << force;
    EXPECT_GT(alarms, 40) << force;
  }
}

/// A sensor that stalls while its noise is measured, and later on, repeats readings; each counts once.
TEST_F(DetectorsTest, AReadingThatIsReadOftenIsOneSample) {
  int contacts = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 50e-9);  // N
    NeedleMonitor monitor{DetectionConfig()};
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3000; ++i) {
      const bool is_new = i % 600 < 500 ? i % 45 == 0 : true;
      if (is_new) force.z() = noise(random);
      is_new ? monitor.step(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), force)
             : monitor.move(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
    }
    contacts += monitor.touched();
  }
  EXPECT_EQ(contacts, 0);
}

TEST_F(DetectorsTest, DriftOfTheSensorIsNoContact) {
  ContactDetector detector(noise_, 10e-9, 1e-7);
  for (int i = 0; i < 60000; ++i) ASSERT_FALSE(detector.step(sample(i * 0.5e-12))) << i;
  EXPECT_NEAR(detector.offset(), kOffset + 30e-9, 2e-9);
}

TEST_F(DetectorsTest, DriftIsNotFollowedWithoutEnd) {
  ContactDetector detector(noise_, 10e-9, 1e-7);
  int steps = 0;
  while (!detector.step(sample(steps * 0.5e-12))) ASSERT_LT(++steps, 200000);
  EXPECT_NEAR(detector.offset(), kOffset + 40e-9, 1e-9);
}

TEST_F(DetectorsTest, ContactIsFeltSoonAfterItIsLargeEnough) {
  double total = 0;
  constexpr int kTrials = 500;
  ContactDetector detector(noise_, 10e-9, 1e-7);
  for (int trial = 0; trial < kTrials; ++trial) {
    detector.reset();
    for (int i = 0; i < 200; ++i) detector.step(sample());
    int steps = 1;
    while (!detector.step(sample(20e-9))) ++steps;
    total += steps;
  }
  // h / (2 - k) samples, a little less for the sum that the noise has left and more for the overshoot.
  const double allowance = 0.5 * 10e-9 / noise_.deviation();
  EXPECT_NEAR(allowance, 0.5, 0.01);
  const double limit = std::log(0.5 / 1e-7) - 1.166;  // of Siegmund's formula for k = 0.5
  EXPECT_NEAR(total / kTrials, limit / (2 - allowance), 2);
}

/// Force (N) of an elastic cell of 0.1 N/m under a needle at 100 um/s, per sample of 1 ms.
constexpr double kRise = 10e-9, kAdvance = 100e-9;

TEST_F(DetectorsTest, PunctureAlarmsFalselyNoMoreOftenThanDesigned) {
  PunctureDetector detector(noise_, 1e-6, 1e-4, 30);
  int alarms = 0;
  for (int i = 0; i < kMillion; ++i) alarms += detector.step(above(), i * kAdvance);
  EXPECT_LE(alarms, 130);
  EXPECT_GT(alarms, 10) << "the bound is of no use";
  PunctureDetector designed(noise_, 0.25, 1e-8, 30);
  for (int i = 0; i < kMillion; ++i) ASSERT_FALSE(designed.step(above(1e-6), i * kAdvance));
}

TEST_F(DetectorsTest, PunctureIsFoundWithinItsLatency) {
  for (const double force : {0.1e-6, 0.3e-6, 1e-6, 5e-6}) {
    PunctureDetector detector(noise_, 0.25, 1e-8, 30);
    int missed = 0;
    double total = 0;
    constexpr int kTrials = 200;
    for (int trial = 0; trial < kTrials; ++trial) {
      detector = PunctureDetector(noise_, 0.25, 1e-8, 30);
      double travel = 0;
      for (int i = 0; i < 600; ++i) ASSERT_FALSE(detector.step(above(force), travel += kAdvance));
      const double expected = detector.latency(force);
      int steps = 1;
      while (!detector.step(above(0.5 * force), travel += kAdvance)) ASSERT_LT(++steps, 600);
      total += steps;
      missed += steps > expected;
    }
    EXPECT_LT(total / kTrials, PunctureDetector(noise_, 0.25, 1e-8, 30).latency(force)) << force;
    EXPECT_LE(missed, 0.05 * kTrials) << force;
  }
}

/// Feeds the needle's way into a Maxwell cell (elastic 0.1 N/m and as much again that relaxes within `relaxation`, s)
/// at speeds (m a sample) over samples; whether a puncture was found.
bool findsPuncture(PunctureDetector& detector, std::initializer_list<std::pair<double, int>> way, double relaxation,
                   const std::function<double(double)>& force) {
  double travel = 0, branch = 0;
  for (const auto& [speed, samples] : way) {
    for (int i = 0; i < samples; ++i) {
      travel += speed;
      branch = std::exp(-1e-3 / relaxation) * (branch + 0.1 * speed);
      if (detector.step(force(0.1 * travel + branch), travel)) return true;
    }
  }
  return false;
}

TEST_F(DetectorsTest, StopRelaxationAndWithdrawalAreNoPuncture) {
  const auto noisy = [this](double force) { return above(force); };
  for (const double relaxation : {0.05, 0.2, 1.0}) {
    PunctureDetector detector(noise_, 0.25, 1e-8, 30);
    EXPECT_FALSE(findsPuncture(detector, {{200e-9, 60}, {0, 1000}}, relaxation, noisy)) << "stop";
    detector.reset();
    EXPECT_FALSE(findsPuncture(detector, {{200e-9, 60}, {0, 300}, {20e-9, 500}}, relaxation, noisy)) << "stop and go";
    detector.reset();
    EXPECT_FALSE(findsPuncture(detector, {{200e-9, 60}, {-50e-9, 200}}, relaxation, noisy)) << "withdrawal";
    detector.reset();
    EXPECT_FALSE(findsPuncture(detector, {{20e-9, 300}, {-20e-9, 250}, {20e-9, 250}}, relaxation, noisy))
        << "to and fro";
    detector.reset();
    EXPECT_FALSE(findsPuncture(detector, {{200e-9, 60}, {20e-9, 1500}}, relaxation, noisy)) << "fast, then slow";
    for (const double slow : {1e-9, 1.5e-9, 3e-9}) {
      detector.reset();
      EXPECT_FALSE(findsPuncture(detector, {{200e-9, 60}, {slow, 4000}}, relaxation, noisy)) << "fast, then very slow";
    }
    detector.reset();
    EXPECT_FALSE(findsPuncture(detector, {{20e-9, 300}, {10e-9, 300}, {20e-9, 300}}, relaxation, noisy))
        << "slower for a while";
  }
}

/// A force that rises to 1 uN within 6 um, falls by a share within 5 ms, which rubbing of the shaft hides in part, and
/// rises slowly again.
TEST_F(DetectorsTest, ASmallFallIsFoundWhereTheNeedleGoesSteadily) {
  constexpr int kBreaks = 300, kAfter = 150;
  const auto found = [&](double share, double speed_after) {
    PunctureDetector detector(noise_, 0.25, 1e-8, 30);
    double travel = 0;
    for (int i = 0; i < kBreaks + kAfter; ++i) {
      const int since = i - kBreaks;
      travel += since < 0 ? 20e-9 : 20e-9 * speed_after;
      const double force =
          since < 0 ? 1e-6 * i / kBreaks : 1e-6 * (1 - share * (1 - std::exp(-since / 5.0))) + 1e-10 * since;
      if (detector.step(above(force), travel)) return since >= 0;
    }
    return false;
  };
  for (const double share : {0.15, 0.2, 0.3, 0.6}) EXPECT_TRUE(found(share, 1)) << share;
  EXPECT_FALSE(found(0.05, 1)) << "a fall that is smaller than what counts";
  EXPECT_FALSE(found(0.15, 0.7)) << "a needle that slows down";
}

/// A hand that goes in at 5 to 20 um/s and trembles by 0.12 um rms, a soft and a stiff cell, a force that is 2 ms late.
TEST_F(DetectorsTest, ATremblingHandIsNoPuncture) {
  const ForceNoise silent = [] {
    ForceNoise noise(100, 5e-9, kChange);
    for (int i = 0; i < 100; ++i) noise.add(0);
    return noise;
  }();
  for (const double speed : {5e-9, 10e-9, 20e-9}) {
    for (const double frequency : {8.0, 9.5, 12.0}) {
      PunctureDetector detector(silent, 0.25, 1e-8, 30);
      int alarms = 0;
      for (int i = 0; i < 2000; ++i) {
        const auto travel = [&](int at) { return speed * at + 0.17e-6 * std::sin(2 * M_PI * frequency * 1e-3 * at); };
        alarms += detector.step(0.1 * std::max(0.0, travel(i - 2)), travel(i));
      }
      EXPECT_EQ(alarms, 0) << speed << ' ' << frequency;
    }
  }
}

TEST_F(DetectorsTest, WhatFallsOnAfterAPunctureIsNotAnother) {
  for (const int pause : {0, 30}) {
    PunctureDetector detector(noise_, 0.25, 1e-8, pause);
    int found = 0;
    for (int i = 0; i < 1000; ++i) {
      const double fallen = i < 500 ? 1 : std::exp(-(i - 500) / 8.0);
      found += detector.step(above(3e-6 * fallen), i * kAdvance);
    }
    if (pause == 30) EXPECT_EQ(found, 1);
    if (pause == 0) EXPECT_GT(found, 1) << "the test would not notice";
  }
}

}  // namespace
}  // namespace microinjection
