#include "cell/penetration/deep_penetration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace microinjection {
namespace {

MaterialConfig incompressible(const std::string& model, double parameter = 0) {
  MaterialConfig material;
  material.model = model;
  material.poisson_ratio = 0.49999;
  material.young_modulus = 2 * (1 + material.poisson_ratio);  // a shear modulus of 1 Pa
  if (model == "ogden") material.ogden_exponent = parameter;
  if (model == "gent") material.gent_limit = parameter;
  return material;
}

TEST(HoleExpansion, IsTheClosedFormOfANeoHookeanBlock) {
  const auto material = makeMaterial(incompressible("neo_hookean"));
  const HoleExpansion hole(*material);
  for (const double x : {0.02, 0.1, 0.3, 0.7, 0.95}) {
    const HoleExpansion::State state = hole.at(x);
    const double square = 1 - x * x;
    EXPECT_NEAR(state.energy / M_PI, square * std::log(1 / x), 1e-4 * square * std::log(1 / x)) << x;
    // The integral of mu ((r / rho)^2 - (rho / r)^2) over ln r, from the shaft outwards.
    EXPECT_NEAR(state.pressure, std::log(1 / x) + square / 2, 2e-3 * (std::log(1 / x) + square / 2)) << x;
  }
}

TEST(HoleExpansion, WhatFitsCostsNothing) {
  const auto material = makeMaterial(incompressible("neo_hookean"));
  EXPECT_NEAR(HoleExpansion(*material).at(1).energy, 0, 1e-12);
}

TEST(HoleExpansion, PressureIsTheSlopeOfTheEnergy) {
  // A compressible block of another law: opened to 1 and to 1 + h from one hole, which is a hole of b / (1 + h) at 1.
  MaterialConfig config = incompressible("ogden", 5);
  config.poisson_ratio = 0.4;
  config.young_modulus = 2.8;
  const auto material = makeMaterial(config);
  const HoleExpansion hole(*material, 2000);
  constexpr double kX = 0.4, kStep = 1e-3;
  const auto energy = [&](double radius) { return radius * radius * hole.at(kX / radius).energy; };
  const double slope = (energy(1 + kStep) - energy(1 - kStep)) / (2 * kStep);
  EXPECT_NEAR(hole.at(kX).pressure, slope / (2 * M_PI), 1e-3 * slope / (2 * M_PI));
}

TEST(HoleExpansion, BeyondALimitOfStretchTheEnergyIsInfinite) {
  const auto material = makeMaterial(incompressible("gent", 10));
  EXPECT_TRUE(std::isinf(HoleExpansion(*material).at(0.2).energy));
  EXPECT_TRUE(std::isfinite(HoleExpansion(*material).at(0.5).energy));
}

TEST(DeepPenetration, PressureOfAFlatPunchInAnOgdenSolid) {
  // p / mu over J / (mu R) for the exponents 2, 3, 5, 9, from the assumptions of Shergold and Fleck 2004.
  const double exponents[] = {2, 3, 5, 9};
  const double toughness[] = {0.1, 1, 10, 50};
  const double expected[4][4] = {
      {0.195, 0.195, 0.195, 0.195}, {1.52, 1.54, 1.58, 1.64}, {3.99, 5.99, 8.70, 11.7}, {5.61, 13.5, 27.9, 46.2}};
  for (int i = 0; i < 4; ++i) {
    const DeepPenetration block(incompressible("ogden", exponents[i]));
    for (int k = 0; k < 4; ++k) {
      const double pressure = block.steady(toughness[k]).force_in / M_PI;
      EXPECT_NEAR(pressure, expected[k][i], 0.006 * expected[k][i]) << exponents[i] << ' ' << toughness[k];
    }
  }
}

TEST(DeepPenetration, WithdrawalGivesBackAllButTheCrack) {
  const DeepPenetration block(incompressible("ogden", 4));
  const SteadyPenetration steady = block.steady(2);
  EXPECT_NEAR(steady.force_in - steady.force_out, 2 * M_PI * steady.hole_radius * 2, 1e-6 * steady.force_in);
  EXPECT_GT(steady.wall_pressure, 0);
}

TEST(DeepPenetration, ToughnessOfAForce) {
  const DeepPenetration block(incompressible("ogden", 5));
  for (const double toughness : {0.05, 1.0, 30.0})
    EXPECT_NEAR(block.toughnessFor(block.steady(toughness).force_in), toughness, 1e-5 * toughness);
  EXPECT_EQ(block.steady(0).force_in, 0);
}

}  // namespace
}  // namespace microinjection
