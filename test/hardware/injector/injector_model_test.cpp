#include "hardware/injector/injector_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/errors.h"
#include "hardware/injector/pulse_ids.h"

namespace microinjection {
namespace {

InjectorModelConfig atRest() {
  InjectorModelConfig config;
  config.balance = PipetteFlow(config.pipette).restPressure();
  return config;
}

double volumeOfPulse(double duration, double step, const InjectorModelConfig& config, double until = 0.5) {
  InjectorModel model(config);
  model.step(0);
  EXPECT_EQ(model.pulse({1, 20e3, duration}), "");
  const int steps = static_cast<int>(std::lround(until / step));
  for (int i = 1; i <= steps; ++i) model.step(i * step);
  EXPECT_FALSE(model.reading().busy);
  return model.reading().volume;
}

/// A tip that leaks fills the cell, one that draws in dilutes what is to be injected.
TEST(InjectorModel, HardlyAnythingLeavesTheTipBetweenPulses) {
  ConfigReader reader(loadYamlMap(std::string(MICROINJECTION_SOURCE_DIR) + "/config/injector.yaml"), "injector.yaml");
  for (const InjectorModelConfig& config : {InjectorModelConfig(), InjectorModelConfig::read(reader)}) {
    const double leak = PipetteFlow(config.pipette).flow(config.balance);
    EXPECT_GT(leak, 0);
    EXPECT_LT(leak, 0.03e-15) << "m^3/s: a third of a per mille of a mouse oocyte's 92 pL";
  }
}

TEST(InjectorModel, VolumeIsThatOfThePressuresIntegral) {
  const InjectorModelConfig config = atRest();
  // What the rise loses, the fall gives back: over a whole pulse the integral is pressure x duration.
  const double exact = PipetteFlow(config.pipette).flow(20e3) * 0.1;
  EXPECT_NEAR(volumeOfPulse(0.1, 1e-3, config) / exact, 1, 1e-9);
}

TEST(InjectorModel, AStopReturnsToTheBalanceAtOnceAndIsNoPulseDone) {
  const InjectorModelConfig config = atRest();
  InjectorModel model(config);
  model.step(0);
  EXPECT_EQ(model.stop(), "") << "nothing to stop is no trouble";
  ASSERT_EQ(model.pulse({7, 20e3, 10}), "");
  model.step(0.1);
  EXPECT_EQ(model.stop(), "");
  EXPECT_FALSE(model.reading().busy);
  model.step(0.6);
  // What the rise lost, the fall gives back: 20 kPa above the rest for 0.1 s.
  const double exact = PipetteFlow(config.pipette).flow(20e3) * 0.1;
  EXPECT_NEAR(model.reading().volume / exact, 1, 1e-9);
  EXPECT_NEAR(model.reading().pressure, config.balance, 1e-6);
  EXPECT_EQ(model.reading().last_id, 0U);
  EXPECT_EQ(model.reading().pulses, 0U);
  EXPECT_EQ(model.pulse({8, 20e3, 0.1}), "");
}

TEST(InjectorModel, NothingDependsOnTheSteps) {
  const InjectorModelConfig config = atRest();
  const double fine = volumeOfPulse(0.0123, 1e-4, config);
  EXPECT_NEAR(volumeOfPulse(0.0123, 0.01, config) / fine, 1, 1e-9);
  EXPECT_NEAR(volumeOfPulse(0.0123, 0.5, config) / fine, 1, 1e-9);
}

TEST(InjectorModel, VolumeIsTheSumOfTheFlow) {
  InjectorModel model(atRest());
  model.step(0);
  model.pulse({1, 20e3, 0.02});
  double sum = 0, before = model.reading().flow;
  const double step = 1e-5;
  for (int i = 1; i <= 5000; ++i) {
    model.step(i * step);
    sum += 0.5 * step * (before + model.reading().flow);
    before = model.reading().flow;
  }
  EXPECT_NEAR(sum / model.reading().volume, 1, 1e-4);
}

TEST(InjectorModel, PressureRisesWithTheRegulatorsTime) {
  InjectorModelConfig config = atRest();
  config.balance = 0;
  config.rise_time = 0.02;
  InjectorModel model(config);
  model.step(0);
  model.pulse({1, 10e3, 1});
  model.step(0.02);
  EXPECT_NEAR(model.reading().pressure, 10e3 * (1 - std::exp(-1)), 1e-6);
}

TEST(InjectorModel, AWrongBalanceFlowsBackOrLeaks) {
  for (const double sign : {-1.0, 1.0}) {
    InjectorModel model(atRest());
    model.step(0);
    EXPECT_EQ(model.setBalance(model.reading().pressure + sign * 100), "");
    model.step(10);
    EXPECT_GT(sign * model.reading().flow, 0);
    EXPECT_GT(sign * model.reading().volume, 0);
    model.reset();
    EXPECT_EQ(model.reading().volume, 0);
  }
}

TEST(InjectorModel, AClogLetsLessThrough) {
  InjectorModel clean(atRest()), clogged(atRest());
  clogged.clog(100);
  for (InjectorModel* model : {&clean, &clogged}) {
    model->step(0);
    model->pulse({1, 20e3, 0.1});
    model->step(1);
  }
  EXPECT_NEAR(clogged.reading().volume / clean.reading().volume, 0.01, 1e-9);
}

TEST(InjectorModel, RefusesWithReasonAndChangesNothing) {
  InjectorModel model(atRest());
  model.step(0);
  EXPECT_EQ(model.pulse({1, 60e3, 0.1}), "pulse pressure = 60000 Pa, allowed [-50000, 50000] Pa");
  EXPECT_EQ(model.pulse({1, 1e3, 0}), "pulse duration = 0 s, allowed [0.001, 60] s");
  const InjectorReading before = model.reading();
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e300, -1e300}) {
    EXPECT_EQ(model.pulse({1, bad, 0.1}).rfind("pulse pressure = ", 0), 0U) << bad;
    EXPECT_EQ(model.pulse({1, 1e3, bad}).rfind("pulse duration = ", 0), 0U) << bad;
    EXPECT_EQ(model.setBalance(bad).rfind("balance pressure = ", 0), 0U) << bad;
  }
  EXPECT_NE(model.setBalance(-60e3), "");
  EXPECT_FALSE(model.reading().busy);
  model.step(0.5);
  EXPECT_EQ(model.reading().pressure, before.pressure);
  EXPECT_EQ(model.pulse({7, 1e3, 0.1}), "");
  EXPECT_EQ(model.pulse({8, 1e3, 0.1}), "a pulse is under way");
  model.step(1);
  EXPECT_EQ(model.reading().last_id, 7U);
  EXPECT_EQ(model.reading().pulses, 1U);
}

TEST(InjectorModel, ReadsItsConfigurationStrictly) {
  ConfigReader reader(YAML::Load("{balance: 1.0e6, pipette: {tip_radius: 1.0, viscosity: 0}}"), "test");
  InjectorModelConfig::read(reader);
  try {
    reader.finish();
    FAIL();
  } catch (const std::exception& error) {
    for (const char* part : {"balance = 1.0e6", "pipette/tip_radius = 1.0", "pipette/viscosity = 0"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in:\n" << error.what();
    }
  }
}

TEST(PulseIds, TellsARepeatedId) {
  PulseIds ids;
  EXPECT_TRUE(ids.isNew(3));
  EXPECT_TRUE(ids.isNew(2));
  EXPECT_FALSE(ids.isNew(3));
}

TEST(InjectorLimits, RangesThatNoInjectorHasAreRefused) {
  for (const char* bad :
       {"{pressure_range: [-1.0e300, 50.0e3]}", "{pressure_range: [0, 1.0e300]}", "{pressure_range: [0, .inf]}",
        "{pressure_range: [.nan, 0]}", "{duration_range: [0, 60]}", "{duration_range: [1, 1.0e300]}"}) {
    const YAML::Node map = YAML::Load(bad);
    ConfigReader reader(map, "test");
    InjectorLimits::read(reader);
    try {
      reader.finish();
      FAIL() << bad;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(map.begin()->first.as<std::string>()), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace microinjection
