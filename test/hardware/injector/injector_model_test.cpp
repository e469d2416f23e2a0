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

constexpr double kDrawLimit = 2e-15;  // m^3

/// After a suction of 10 kPa below the rest, whose end nobody commands.
InjectorModel drawnFull(double step, double until = 2) {
  InjectorModelConfig config = atRest();
  config.draw_limit = kDrawLimit;
  InjectorModel model(config);
  model.step(0);
  EXPECT_EQ(model.setBalance(config.balance - 10e3), "");
  const int steps = static_cast<int>(std::lround(until / step));
  for (int i = 1; i <= steps; ++i) model.step(i * step);
  return model;
}

TEST(InjectorModel, ASuctionEndsWithExactlyItsLimitWhateverTheStep) {
  for (const double step : {1e-4, 5e-3, 0.5, 2.0}) {
    InjectorModel model = drawnFull(step);
    EXPECT_NEAR(model.reading().drawn / kDrawLimit, 1, 1e-9) << step;
    EXPECT_NEAR(model.reading().volume / -kDrawLimit, 1, 1e-9) << step;
    EXPECT_NEAR(model.reading().pressure, model.restPressure(), 1e-6);
    EXPECT_TRUE(model.reading().limited);
    EXPECT_NEAR(model.reading().interface, interfaceDepth(PipetteConfig(), kDrawLimit), 1e-12);
  }
  // Half way it is not limited yet: what the limit ends is the suction, and not its beginning.
  const double half = kDrawLimit / 2 / -PipetteFlow(PipetteConfig()).flow(atRest().balance - 10e3);
  EXPECT_FALSE(drawnFull(half / 100, half).reading().limited);
}

TEST(InjectorModel, AFullPipetteDrawsNoMoreUntilItIsPushedOut) {
  InjectorModel model = drawnFull(0.5);
  const double rest = model.restPressure();
  EXPECT_EQ(model.setBalance(rest - 1),
            "draw_limit = 2e-15 m^3 is reached; push out what was drawn in first, or reset");
  EXPECT_NE(model.pulse({1, rest - 100, 0.1}), "");
  EXPECT_EQ(model.setBalance(rest + 10e3), "");
  model.step(2.1);
  EXPECT_FALSE(model.reading().limited);
  EXPECT_LT(model.reading().drawn, kDrawLimit);
  model.step(100);
  EXPECT_EQ(model.reading().drawn, 0) << "what leaves now is the filling";
  EXPECT_EQ(model.setBalance(rest - 10e3), "");
  model.step(200);
  EXPECT_NEAR(model.reading().drawn / kDrawLimit, 1, 1e-9) << "the limit counts from the filling's end";
  EXPECT_TRUE(model.reading().limited);
  model.reset();
  EXPECT_EQ(model.reading().drawn, 0);
  EXPECT_EQ(model.setBalance(rest - 10e3), "");
}

TEST(InjectorModel, APulseOfSuctionEndsAtTheLimitAndDoesNotCount) {
  InjectorModelConfig config = atRest();
  config.draw_limit = kDrawLimit;
  InjectorModel model(config);
  model.step(0);
  ASSERT_EQ(model.pulse({1, config.balance - 20e3, 60}), "");
  model.step(1);
  EXPECT_FALSE(model.reading().busy);
  EXPECT_EQ(model.reading().pulses, 0U);
  EXPECT_NEAR(model.reading().drawn / kDrawLimit, 1, 1e-9);
}

TEST(InjectorModel, WhatIsDrawnCountsFromTheTurnOfTheFlow) {
  const InjectorModelConfig config = atRest();
  for (const double step : {1e-4, 0.05}) {
    InjectorModel model(config);
    model.step(0);
    model.setBalance(config.balance + 10e3);
    model.step(0.1);
    const double out = model.reading().volume;
    EXPECT_EQ(model.reading().drawn, 0);
    model.setBalance(config.balance - 10e3);
    for (int i = 1; i <= std::lround(0.05 / step); ++i) model.step(0.1 + i * step);
    // Until the turn, rise_time ln 2 later, medium could not be drawn in: p - rest = 10 kPa (2 exp(-t / tau) - 1).
    const double tau = config.rise_time, unit = PipetteFlow(config.pipette).flow(config.balance + 10e3);
    EXPECT_NEAR(model.reading().drawn, unit * (0.05 - tau * std::log(2.0) - tau * (1 - 2 * std::exp(-0.05 / tau))),
                1e-9 * out)
        << step;
  }
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
