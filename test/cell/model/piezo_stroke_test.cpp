#include "cell/model/piezo_stroke.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cell/model/puncture_drive.h"
#include "cell/model/spring_branch.h"

namespace microinjection {
namespace {

TEST(StrokeResistance, IsTheLargestForceOfTheTipsMotion) {
  for (const double viscosity : {1e-3, 0.2, 5.0}) {
    for (const double rise_time : {5e-6, 50e-6, 1e-3}) {
      const StrokeResistance resistance{3e-6, viscosity, 0.08};
      const PiezoPulse pulse{0.7e-6, rise_time};
      const auto place = [&](double t) { return pulse.amplitude * (1 - std::cos(M_PI * t / rise_time)) / 2; };
      const double mass = 4.0 / 3 * 1e3 * std::pow(3e-6, 3), drag = 8 * viscosity * 3e-6, dt = 1e-3 * rise_time;
      double largest = 0;
      for (double t = 0; t <= rise_time; t += dt / 4) {
        const double speed = (place(t + dt) - place(t - dt)) / (2 * dt);
        const double acceleration = (place(t + dt) - 2 * place(t) + place(t - dt)) / (dt * dt);
        largest = std::max(largest, 0.08 * place(t) + drag * speed + mass * acceleration);
      }
      EXPECT_NEAR(resistance.largestForce(pulse), largest, 1e-4 * largest) << viscosity << " " << rise_time;
    }
  }
}

TEST(StrokeResistance, ASlowPulseIsADeeperDent) {
  EXPECT_NEAR((StrokeResistance{3e-6, 0.2, 0.1}.largestForce({1e-6, 10})), 0.1 * 1e-6, 1e-12);
}

/// N, of a cell of PunctureDrive.
double strokeForce(const PiezoPulse& pulse) { return StrokeResistance{3e-6, 0.2, kStiffness}.largestForce(pulse); }

PunctureConfig atMicronewton() {
  PunctureConfig config = PunctureConfig::atForce(1e-6);
  config.cytoplasm_viscosity = 0.2;
  return config;
}

TEST(PiezoPuncture, BreaksInAShallowerDent) {
  const PiezoPulse pulse{0.5e-6, 25e-6};
  const double enough = (1e-6 - strokeForce(pulse)) / kStiffness;
  for (const double share : {0.95, 1.05}) {
    PunctureDrive needle(atMicronewton());
    needle.toDepth(share * enough);
    needle.cell->strike(pulse);
    needle.rest(0.005);
    EXPECT_EQ(needle.layers(), share > 1 ? 1 : 0) << share;
  }
}

TEST(PiezoPuncture, APulseIsOverAfterItsStep) {
  const PiezoPulse pulse{0.5e-6, 25e-6};
  PunctureDrive needle(atMicronewton());
  needle.cell->strike(pulse);
  needle.rest(0.001);  // in the medium
  needle.toDepth(9.9e-6);
  EXPECT_EQ(needle.layers(), 0);
}

TEST(PiezoPuncture, TheHandGetsNothingOfThePiezosWork) {
  const SpringBranch branch;
  PunctureConfig tough;
  tough.layers.emplace_back().toughness = 1;
  for (const double rate : {50.0, 1000.0}) {
    for (const double depth : {0.5e-6, 3e-6, 10e-6, 20e-6}) {
      PunctureDrive needle(tough, rate, branch.make());
      needle.toDepth(depth);
      needle.cell->strike({5e-6, 5e-6});
      needle.rest(1 / rate);
      ASSERT_EQ(needle.layers(), 1) << depth;
      needle.rest(0.2);
      needle.toDepth(30e-6, 80e-6);
      EXPECT_NEAR(needle.rest(0.2), branch.opened + branch.cost, 0.01 * branch.cost) << depth << ": as any other hole";
      needle.toDepth(-1e-6, 80e-6);
      needle.rest(0.1);
      EXPECT_GE(needle.least_work, -1e-20) << depth << " " << rate;
    }
  }
}

TEST(PiezoPuncture, BreaksTheNextLayerToo) {
  PunctureDrive needle(oocyte());
  needle.toDepth(14e-6);
  ASSERT_EQ(needle.layers(), 1);
  needle.cell->strike({2e-6, 25e-6});
  needle.rest(0.005);
  EXPECT_EQ(needle.layers(), 2);
}

}  // namespace
}  // namespace microinjection
