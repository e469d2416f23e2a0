#include "hardware/injector/pipette_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

PipetteConfig straight(double radius, double length) {
  PipetteConfig config;
  config.tip_radius = config.shaft_radius = radius;
  config.tip_length = length;
  config.taper_length = config.shaft_length = 0;
  config.surface_tension = 0;
  return config;
}

TEST(PipetteFlow, StraightPipeIsHagenPoiseuille) {
  // Water, 10 um radius, 1 mm, 1 kPa: Q = pi r^4 dp / (8 mu L) = 3.927e-12 m^3/s.
  EXPECT_NEAR(PipetteFlow(straight(10e-6, 1e-3)).flow(1000), M_PI * 1e-20 * 1000 / (8 * 1e-3 * 1e-3), 1e-24);
}

TEST(PipetteFlow, ConeIsTheSumOfItsThinSlices) {
  const double r1 = 1e-6, r2 = 250e-6, length = 8e-3;
  double sum = 0;
  const int n = 2000000;
  for (int i = 0; i < n; ++i) {
    const double r = r1 + (r2 - r1) * (i + 0.5) / n;
    sum += length / n / (r * r * r * r);
  }
  EXPECT_NEAR(coneResistanceIntegral(r1, r2, length) / sum, 1, 1e-3);
  EXPECT_DOUBLE_EQ(coneResistanceIntegral(r1, r2, length), coneResistanceIntegral(r2, r1, length));
}

TEST(PipetteFlow, ConeBecomesAStraightPipe) {
  const double r = 3e-6;
  EXPECT_NEAR(coneResistanceIntegral(r, r * (1 + 1e-9), 1e-3) * std::pow(r, 4) / 1e-3, 1, 1e-8);
}

TEST(PipetteFlow, CapillarityDrawsBackUntilTheBalancePressure) {
  PipetteConfig config;
  config.surface_tension = 0.072;
  config.contact_angle = 0;
  config.meniscus_radius = 0.25e-3;
  PipetteFlow flow(config);
  EXPECT_NEAR(flow.restPressure(), 576, 1e-9);  // 2 x 0.072 / 0.25e-3
  EXPECT_LT(flow.flow(500), 0);
  EXPECT_GT(flow.flow(600), 0);
  EXPECT_EQ(flow.flow(flow.restPressure()), 0);
  config.contact_angle = M_PI;  // a liquid that does not wet is pushed out
  EXPECT_GT(PipetteFlow(config).flow(0), 0);
  config.contact_angle = 0;
  config.outside_pressure = 100;
  EXPECT_LT(PipetteFlow(config).flow(600), 0);
}

TEST(PipetteFlow, TheInterfaceIsWhereThePipetteHoldsWhatWasDrawn) {
  const PipetteConfig config;
  const auto radius = [&](double z) {
    const double along = std::clamp((z - config.tip_length) / config.taper_length, 0.0, 1.0);
    return config.tip_radius + along * (config.shaft_radius - config.tip_radius);
  };
  double volume = 0, z = 0;
  const double slice = 0.5e-6;
  for (const double place : {20e-6, 50e-6, 80e-6, 1e-3, 8.05e-3, 12e-3}) {
    for (; z < place - slice / 2; z += slice) volume += M_PI * std::pow(radius(z + slice / 2), 2) * slice;
    EXPECT_NEAR(interfaceDepth(config, volume) / place, 1, 1e-4) << place;
  }
  EXPECT_EQ(interfaceDepth(config, 0), 0);
  PipetteConfig nearly = straight(10e-6, 1e-4);
  nearly.taper_length = 1e-3;
  nearly.shaft_radius = 10e-6 * (1 + 1e-13);
  EXPECT_NEAR(interfaceDepth(nearly, M_PI * 1e-10 * 5e-4), 5e-4, 1e-9);
  nearly.shaft_radius = 10e-6;
  EXPECT_NEAR(interfaceDepth(nearly, M_PI * 1e-10 * 2e-3), 2e-3, 1e-9) << "beyond a cone that is none";
}

TEST(PipetteFlow, ClogDividesTheFlow) {
  const PipetteFlow flow{PipetteConfig()};
  EXPECT_NEAR(flow.flow(20e3, 50), flow.flow(20e3) / 50, 1e-25);
}

TEST(PipetteFlow, TheSmallestRadiusDecides) {
  PipetteConfig config;
  const double wide = PipetteFlow(config).resistance();
  config.shaft_length *= 10;
  const double longer = PipetteFlow(config).resistance();
  EXPECT_GT(longer, wide);
  EXPECT_LT(longer / wide, 1 + 1e-5);
  config.viscosity *= 2;
  EXPECT_NEAR(PipetteFlow(config).resistance() / longer, 2, 1e-12);
}

}  // namespace
}  // namespace microinjection
