#include "hardware/injector/pressure_line.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"

namespace microinjection {
namespace {

PipetteConfig holdingPipette() {
  PipetteConfig pipette;
  pipette.tip_radius = 10e-6;
  pipette.surface_tension = 0;
  return pipette;
}

PressureLine lineAt(double pressure, const PressureLineConfig& config = {}) {
  PressureLine line(config, holdingPipette(), pressure);
  line.step(0);
  return line;
}

void run(PressureLine& line, double from, double until, double step) {
  const int steps = static_cast<int>(std::lround((until - from) / step));
  for (int i = 1; i <= steps; ++i) line.step(from + i * step);
}

TEST(PressureLine, ASealedLineFollowsItsSourceWithTwoTimes) {
  const PressureLineConfig config;
  const double a = config.rise_time, b = config.tube_resistance * config.tube_compliance, target = -2000;
  PressureLine line = lineAt(0);
  line.setTarget(target);
  for (const double time : {0.01, 0.1, 0.5, 3.0}) {
    line.step(time);
    EXPECT_NEAR(line.reading().source, target * -std::expm1(-time / a), 1e-6);
    const double p = target * (1 - (b * std::exp(-time / b) - a * std::exp(-time / a)) / (b - a));
    EXPECT_NEAR(line.reading().mouth, p, 1e-6);
    EXPECT_EQ(line.reading().flow, 0);
    EXPECT_EQ(line.reading().volume, 0);
  }
}

TEST(PressureLine, NothingDependsOnTheSteps) {
  PressureLineConfig syringe;
  syringe.syringe_compliance = 1e-12;
  for (const PressureLineConfig& config : {PressureLineConfig(), syringe}) {
    for (const double resistance : {0.0, 1e14, double(INFINITY)}) {
      PressureLineReading fine;
      for (const double step : {1e-3, 0.05, 1.0}) {
        PressureLine line = lineAt(-500, config);
        line.setSeal({resistance, 3e-15});
        line.setTarget(-3000);
        run(line, 0, 1, step);
        line.setTarget(0);
        run(line, 1, 3, step);
        if (step == 1e-3) fine = line.reading();
        EXPECT_NEAR(line.reading().source, fine.source, 1e-6);
        EXPECT_NEAR(line.reading().mouth, fine.mouth, 1e-6);
        EXPECT_NEAR(line.reading().volume / fine.volume, 1, 1e-8);
      }
    }
  }
}

/// What leaves the mouth has come out of the compliances of syringe and tube.
TEST(PressureLine, ASyringeLosesItsSuctionThroughALeakAndNoVolumeIsLost) {
  PressureLineConfig config;
  config.syringe_compliance = 5e-13;
  PressureLine line = lineAt(-4000, config);
  line.setSeal({2e14, 0});
  for (const double time : {1.0, 20.0, 2000.0}) {
    line.step(time);
    const PressureLineReading& reading = line.reading();
    const double stored =
        config.syringe_compliance * (reading.source + 4000) + config.tube_compliance * (reading.pipette + 4000);
    EXPECT_NEAR(reading.volume / -stored, 1, 1e-7) << time;
    EXPECT_LT(reading.volume, 0) << "it draws in";
  }
  EXPECT_NEAR(line.reading().mouth, 0, 1) << "nothing is left of the suction";
  line.setTarget(-4000);  // the piston moves by what is missing
  line.step(2002);
  EXPECT_LT(line.reading().source, -3500);
}

TEST(PressureLine, ARegulatorFeedsALeak) {
  const PressureLineConfig config;
  PressureLine line = lineAt(-4000);
  const double gap = 5e13;
  line.setSeal({gap, 0});
  run(line, 0, 10, 0.1);
  const double in_all = config.tube_resistance + PipetteFlow(holdingPipette()).resistance() + gap;
  EXPECT_NEAR(line.reading().flow / (-4000 / in_all), 1, 1e-9);
  EXPECT_NEAR(line.reading().mouth / (-4000 * gap / in_all), 1, 1e-9);
  EXPECT_NEAR(line.reading().source, -4000, 1e-6);
  line.setSeal({0, 0});
  EXPECT_EQ(line.reading().mouth, 0) << "an open mouth has the dish's pressure";
}

TEST(PressureLine, ATongueThatIsDrawnInRaisesThePressure) {
  const PressureLineConfig config;
  const double inflow = 1e-13;
  PressureLine line = lineAt(-2000);
  line.setSeal({INFINITY, inflow});
  line.step(1e-4);
  EXPECT_NEAR((line.reading().pipette + 2000) / (inflow * 1e-4 / config.tube_compliance), 1, 1e-3);
  EXPECT_NEAR(line.reading().volume / (-inflow * 1e-4), 1, 1e-9);
  line.step(10);
  EXPECT_NEAR(line.reading().pipette, -2000 + inflow * config.tube_resistance, 1e-6);
  const double drop = inflow * PipetteFlow(holdingPipette()).resistance();
  EXPECT_NEAR(line.reading().mouth - line.reading().pipette, drop, 1e-9);
}

TEST(PressureLine, AMeniscusDrawsAtTheMouth) {
  PipetteConfig pipette = holdingPipette();
  pipette.surface_tension = 0.072;
  pipette.contact_angle = 0;
  pipette.meniscus_radius = 0.36e-3;
  pipette.outside_pressure = 50;
  PressureLine line({}, pipette, 1000);
  EXPECT_NEAR(line.reading().mouth, 600, 1e-9);  // 2 x 0.072 / 0.36e-3 = 400
  line.setSeal({0, 0});
  EXPECT_NEAR(line.reading().mouth, 50, 1e-9);
}

TEST(PressureLine, ARealSourceIsWhatItSays) {
  PressureLine line = lineAt(0);
  line.setSource(-1500);
  EXPECT_EQ(line.reading().source, -1500);
  line.step(0.1);
  EXPECT_NEAR(line.reading().source, -1500, 1e-6);
  const PressureLineConfig config;
  const double b = config.tube_resistance * config.tube_compliance;
  EXPECT_NEAR(line.reading().mouth, 1500 * std::expm1(-0.1 / b), 1e-6);
}

TEST(PressureLine, ATubeThatNoneHasIsRefused) {
  for (const char* bad : {"{tube_resistance: 0}", "{tube_compliance: -1}",
                          "{tube_resistance: 1, tube_compliance: 1e-9}", "{syringe_compliance: .inf}"}) {
    ConfigReader reader(YAML::Load(bad), "test");
    PressureLineConfig::read(reader);
    EXPECT_THROW(reader.finish(), ConfigError) << bad;
  }
}

}  // namespace
}  // namespace microinjection
