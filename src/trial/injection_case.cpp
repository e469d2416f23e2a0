#include "trial/injection_case.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace microinjection {

InjectionCase randomInjectionCase(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto even = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto evenLog = [&](double low, double high) { return low * std::pow(high / low, even(0, 1)); };
  InjectionCase result;
  result.seed = seed;
  result.cell.diameter = even(20e-6, 150e-6);
  result.cell.young_modulus = evenLog(2e3, 45e3);
  result.believed_modulus = result.cell.young_modulus * evenLog(0.75, 1.33);
  const double radius = 0.5 * result.cell.diameter, scale = result.cell.young_modulus * radius * radius;
  result.cell.prony = {{even(0.1, 0.6), evenLog(0.1, 0.5)}, {even(0.1, 0.4), evenLog(0.5, 3)}};
  const double strength = scale * evenLog(0.03, 0.13);
  result.cell.puncture = PunctureConfig::atForce(strength);
  if (seed % 2 == 0) {
    PunctureConfig::Layer oolemma;
    oolemma.name = "oolemma";
    oolemma.force = even(0.3, 0.8) * strength;
    oolemma.stiffness = oolemma.force / (even(0.03, 0.08) * result.cell.diameter);
    oolemma.gap = even(0.005, 0.02) * result.cell.diameter;
    result.cell.puncture.layers.push_back(oolemma);
  }
  result.cell.puncture.relaxation_time = evenLog(1e-3, 10e-3);
  result.cell.puncture.shaft.friction = even(0, 0.3) * strength;
  result.cell.puncture.shaft.stiffness = scale / radius;
  const double angle = even(0, 2 * M_PI), far = 0.3 * radius * std::sqrt(even(0, 1));
  result.offset = far * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  result.gap = even(5e-6, 20e-6);
  return result;
}

InjectionCase randomSuctionCase(int seed) {
  InjectionCase result = randomInjectionCase(seed);
  std::mt19937 random(static_cast<unsigned>(seed) + 700000);
  const auto even = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto evenLog = [&](double low, double high) { return low * std::pow(high / low, even(0, 1)); };
  const double diameter = even(50e-6, 150e-6), modulus = evenLog(1e3, 5e3), before = result.cell.diameter;
  const double force = modulus / result.cell.young_modulus * diameter * diameter / (before * before);
  result.cell.puncture.layers.resize(1);
  result.cell.puncture.layers.front().force *= force;
  result.cell.puncture.shaft.friction *= force;
  result.cell.puncture.shaft.stiffness *= force * before / diameter;
  result.cell.diameter = diameter;
  result.believed_modulus *= modulus / result.cell.young_modulus;
  result.cell.young_modulus = modulus;
  result.offset *= diameter / before;
  // The trial's tip grows with its cell: 3 um on a cell of 56 um (ScaledCell).
  const double bore = std::min(even(2e-6, 3.5e-6), 0.85 * 3 * diameter / 56), suction = evenLog(0.06, 0.25) * modulus;
  result.cell.bore_radius = bore;
  AspirationConfig& aspiration = result.cell.puncture.layers.front().aspiration.emplace();
  aspiration.tension = suction * bore / (2 * (1 - 2 * bore / diameter));
  if (seed % 2 == 0) aspiration.tension_scale = even(0.03, 0.1) * aspiration.tension;
  if (seed % 10 == 9) aspiration.mode = "none";
  result.cell.puncture.cytoplasm_viscosity = evenLog(0.1, 1);
  result.pipette.tip_radius = bore;
  result.pipette.viscosity = evenLog(2e-3, 50e-3);
  return result;
}

Eigen::Vector3d startOf(const InjectionCase& of) {
  const double radius = 0.5 * of.cell.diameter, top = std::sqrt(radius * radius - of.offset.squaredNorm());
  return {of.offset.x(), of.offset.y(), top + of.gap};
}

InjectionControllerConfig injectionSettings(const InjectionCase& of) {
  const double diameter = of.cell.diameter, radius = 0.5 * diameter, scale = of.believed_modulus * radius * radius;
  InjectionControllerConfig config;
  config.mode = "automatic";
  config.guards.force_limit = std::max(0.3 * scale, 100e-9);  // ten times the noise
  config.guards.depth_limit = 0.5 * diameter;
  config.detection.contact_force = std::clamp(0.003 * scale, 8e-9, 50e-9);
  config.motion.approach_speed = std::min(20e-6, 0.25 * diameter);
  config.motion.travel_limit = of.gap + 0.35 * diameter;
  config.motion.indent_speed = 0.05 * diameter;
  config.motion.stab_speed = std::min(200e-6, 4 * diameter);
  config.motion.overshoot = 0.04 * diameter;
  config.goal.layers = static_cast<int>(of.cell.puncture.layers.size());
  config.goal.depth = 0.42 * diameter;
  config.goal.margin = 0.03 * diameter;
  return config;
}

InjectionControllerConfig suctionSettings(const InjectionCase& of) {
  InjectionControllerConfig config = injectionSettings(of);
  config.goal.break_by = BreakBy::kSuction;
  config.goal.suction.dent = 0.07 * of.cell.diameter;
  config.goal.suction.largest = 0.35 * of.believed_modulus;
  config.goal.suction.rate = 0.15 * of.believed_modulus;
  config.goal.pulse.duration = 0;
  return config;
}

std::optional<ExpectedPuncture> expectedPuncture(const InjectionCase& of, double deviation) {
  if (deviation <= 0) return std::nullopt;
  constexpr double kInterval = 1.96, kShallowest = 0.05, kDeepest = 0.4;  // of 95 %; in diameters
  std::mt19937 random(static_cast<unsigned>(of.seed) + 500000);
  const double off = std::normal_distribution<double>(0, deviation)(random);
  const double force = of.cell.puncture.layers.front().force * std::exp(off), wide = std::exp(kInterval * deviation);
  return ExpectedPuncture{force / wide, force * wide, kShallowest * of.cell.diameter, kDeepest * of.cell.diameter};
}

}  // namespace microinjection
