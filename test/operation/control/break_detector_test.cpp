#include "operation/control/break_detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "operation/control/suction_run.h"

namespace microinjection {
namespace {

using Verdict = BreakDetector::Verdict;

constexpr double kForceNoise = 10e-9;  // N

/// A membrane under suction in virtual time: what the witnesses see of it, with noise.
class Witnessed {
 public:
  explicit Witnessed(unsigned seed) : random_(seed) {}
  /// `force`: N; `interface`: m, shown by every twentieth step
  std::optional<double> force(double mean) { return mean + kForceNoise * normal_(random_); }
  std::optional<InterfaceReading> interface(double position) {
    const bool is_new = count_++ % 20 == 0;
    if (is_new) shown_ = position + 0.15e-6 * normal_(random_);
    return InterfaceReading{shown_, is_new};
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
  int count_ = 0;
  double shown_ = 0;
};

TEST(FallDetector, TellsAFallFromARelaxation) {
  FallDetector relaxing(kForceNoise, 0.25, 1e-7), falling(kForceNoise, 0.25, 1e-7);
  Witnessed witnessed(1);
  for (int i = 0; i < 3000; ++i) ASSERT_FALSE(relaxing.step(*witnessed.force(1e-6 * std::exp(-i / 300.0)))) << i;
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(falling.step(*witnessed.force(0.3e-6)));
  int latency = 0;
  while (!falling.step(*witnessed.force(0.3e-6 * std::exp(-latency / 3.0)))) ASSERT_LT(++latency, 20);
  EXPECT_NEAR(falling.before(), 0.3e-6, 10e-9);
  EXPECT_LT(falling.now(), 0.2e-6);
}

/// False alarms of noise alone come as seldom as asked for.
TEST(RiseDetector, KeepsItsRateOfFalseAlarms) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1);
  RiseDetector detector(1, 2, 1e-3);
  int alarms = 0;
  for (int i = 0; i < 200000; ++i) {
    if (!detector.step(normal(random))) continue;
    ++alarms;
    detector.reset();
  }
  EXPECT_LT(alarms, 400);
  EXPECT_GT(alarms, 20);
}

TEST(BreakDetector, DoesNotTakeAGrowingTongueForABreak) {
  BreakDetector detector({}, kForceNoise);
  Witnessed witnessed(2);
  for (int i = 0; i < 10000; ++i) {
    ASSERT_EQ(detector.watch(witnessed.force(0.2e-6), witnessed.interface(3e-6 * i / 10000), {}, 1e-3), "") << i;
  }
}

/// The tongue of 1 um, and the cytoplasm that follows at 60 um/s until the alarm; a tongue that springs back is no
/// break, whatever alarmed.
TEST(BreakDetector, ConfirmsWhatStaysAndDeniesWhatSpringsBack) {
  for (const bool broken : {true, false}) {
    BreakDetector detector({}, kForceNoise);
    Witnessed witnessed(3);
    for (int i = 0; i < 150; ++i) detector.watch(witnessed.force(0.2e-6), witnessed.interface(0), {}, 1e-3);
    std::string alarm;
    double position = 1e-6;
    int latency = 0;
    for (; alarm.empty() && latency < 200; ++latency, position += 60e-9) {
      alarm = detector.watch(witnessed.force(0.2e-6), witnessed.interface(position), {}, 1e-3);
    }
    EXPECT_EQ(alarm, "image");
    EXPECT_LT(latency, 60);
    std::optional<Verdict> confirmed;
    while (!confirmed) {
      confirmed = detector.confirm(witnessed.force(0.2e-6), witnessed.interface(broken ? position : 0), 1e-3);
    }
    EXPECT_EQ(*confirmed, broken ? Verdict::kBroken : Verdict::kWhole);
  }
}

TEST(BreakDetector, TheForceAloneTellsABreak) {
  for (const bool broken : {true, false}) {
    BreakDetector detector({}, kForceNoise);
    Witnessed witnessed(4);
    for (int i = 0; i < 300; ++i) ASSERT_EQ(detector.watch(witnessed.force(0.2e-6), {}, {}, 1e-3), "");
    std::string alarm;
    for (int i = 0; alarm.empty() && i < 100; ++i) alarm = detector.watch(witnessed.force(0.05e-6), {}, {}, 1e-3);
    EXPECT_EQ(alarm, "force");
    std::optional<Verdict> confirmed;
    while (!confirmed) confirmed = detector.confirm(witnessed.force(broken ? 0.05e-6 : 0.2e-6), {}, 1e-3);
    EXPECT_EQ(*confirmed, broken ? Verdict::kBroken : Verdict::kWhole);
  }
}

TEST(BreakDetector, AMeasuredFlowTellsABreak) {
  BreakDetectionConfig config;
  config.flow_noise = 0.1e-15;
  BreakDetector detector(config, kForceNoise);
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, config.flow_noise);
  for (int i = 0; i < 5000; ++i) ASSERT_EQ(detector.watch({}, {}, noise(random), 1e-3), "");
  int latency = 0;
  while (detector.watch({}, {}, 1e-15 + noise(random), 1e-3).empty()) ASSERT_LT(++latency, 10);
}

/// Images that end with their alarm, or a flow that nobody can ask again: no word is no whole membrane.
TEST(BreakDetector, NobodyHeardIsNoWholeMembrane) {
  BreakDetectionConfig config;
  config.flow_noise = 0.1e-15;
  BreakDetector by_flow(config, kForceNoise), by_image({}, kForceNoise);
  for (int i = 0; i < 200; ++i) by_flow.watch({}, {}, 0, 1e-3);
  while (by_flow.watch({}, {}, 2e-15, 1e-3).empty()) {
  }
  Witnessed witnessed(8);
  for (int i = 0; i < 150; ++i) by_image.watch({}, witnessed.interface(0), {}, 1e-3);
  for (double position = 0; by_image.watch({}, witnessed.interface(position), {}, 1e-3).empty(); position += 0.1e-6) {
  }
  for (BreakDetector* detector : {&by_flow, &by_image}) {
    std::optional<Verdict> verdict;
    for (int i = 0; i < 2000 && !verdict; ++i) verdict = detector->confirm({}, {}, 1e-3);
    ASSERT_TRUE(verdict);
    EXPECT_EQ(*verdict, Verdict::kUnknown);
  }
}

/// In steps of 1 ms with an injector that reports, and draws as it is told.
class Suction {
 public:
  explicit Suction(const SuctionGoal& goal) : run(goal, {}, kForceNoise) {}
  SuctionRun::Status step(double force, std::optional<InterfaceReading> interface, bool reports = true) {
    const auto drawn = run.pressure();
    const InjectorReport obeying{drawn.has_value(), 0, false, "", drawn.value_or(500), 0};
    const auto report = reports ? std::optional(obeying) : std::nullopt;
    return run.step(force, interface, report, 1e-3);
  }
  SuctionRun run;
};

TEST(SuctionRun, GrowsToItsLargestAndGivesUp) {
  SuctionGoal goal;
  goal.largest = 1000;
  goal.rate = 500;
  goal.time = 0.5;
  Suction suction(goal);
  double time = 0, lowest = INFINITY;
  SuctionRun::Status status = SuctionRun::Status::kUnderWay;
  for (; status == SuctionRun::Status::kUnderWay && time < 10; time += 1e-3) {
    status = suction.step(0.2e-6, {});
    lowest = std::min(lowest, suction.run.pressure().value_or(500));
  }
  EXPECT_EQ(status, SuctionRun::Status::kWhole);
  EXPECT_NEAR(time, 0.15 + 2 + 0.5, 0.01);
  EXPECT_DOUBLE_EQ(lowest, 500 - 1000);
}

TEST(SuctionRun, EndsTheSuctionAtTheAlarm) {
  Suction suction({});
  Witnessed witnessed(6);
  for (int i = 0; i < 1000; ++i) suction.step(*witnessed.force(0.2e-6), {});
  ASSERT_TRUE(suction.run.pressure());
  int steps = 0;
  while (suction.run.pressure()) {
    suction.step(*witnessed.force(0.02e-6), {});
    ASSERT_LT(++steps, 45);
  }
  SuctionRun::Status status = SuctionRun::Status::kUnderWay;
  while (status == SuctionRun::Status::kUnderWay) {
    EXPECT_FALSE(suction.run.pressure());
    status = suction.step(*witnessed.force(0.02e-6), {});
  }
  EXPECT_EQ(status, SuctionRun::Status::kBroken);
  EXPECT_EQ(suction.run.witness(), "force");
  EXPECT_NEAR(suction.run.suction(), 500 * 0.85, 25);
}

TEST(SuctionRun, DoesNotDrawWhereNoBreakCouldBeTold) {
  Suction suction({});
  SuctionRun::Status status = SuctionRun::Status::kUnderWay;
  for (int i = 0; i < 200 && status == SuctionRun::Status::kUnderWay; ++i) status = suction.step(5e-9, {});
  EXPECT_EQ(status, SuctionRun::Status::kBlind);
}

TEST(SuctionRun, EndsWhereTheInterfaceMayNotGo) {
  SuctionGoal goal;
  goal.length = 5e-6;
  Suction suction(goal);
  for (int i = 0; i < 400; ++i) suction.step(0.2e-6, InterfaceReading{0, i % 20 == 0});
  double position = 0;
  while (position < 5.1e-6) suction.step(0.2e-6, InterfaceReading{position += 1e-9, true});
  EXPECT_FALSE(suction.run.pressure());
  SuctionRun::Status status = SuctionRun::Status::kUnderWay;
  for (int i = 0; i < 1000 && status == SuctionRun::Status::kUnderWay; ++i) {
    status = suction.step(0.2e-6, InterfaceReading{0, i % 20 == 0});
  }
  EXPECT_EQ(status, SuctionRun::Status::kTooMuch);
}

TEST(SuctionRun, AnInjectorThatDoesNotReportEndsIt) {
  Suction suction({});
  for (int i = 0; i < 500; ++i) ASSERT_EQ(suction.step(0.2e-6, {}), SuctionRun::Status::kUnderWay);
  int steps = 0;
  while (suction.step(0.2e-6, {}, false) == SuctionRun::Status::kUnderWay) ASSERT_LT(++steps, 250);
  EXPECT_EQ(suction.step(0.2e-6, {}, false), SuctionRun::Status::kInjector);
}

TEST(SuctionRun, FalseAlarmsDoNotGoOnForEver) {
  Suction suction({});
  SuctionRun::Status status = SuctionRun::Status::kUnderWay;
  for (int i = 0; i < 60000 && status == SuctionRun::Status::kUnderWay; ++i) {
    status = suction.step(suction.run.pressure() && i % 400 > 350 ? 0.02e-6 : 0.2e-6, {});
  }
  EXPECT_EQ(status, SuctionRun::Status::kNoWord);
  EXPECT_EQ(suction.run.falseAlarms(), 6);
}

}  // namespace
}  // namespace microinjection
