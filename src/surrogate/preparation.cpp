#include "surrogate/preparation.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "cell/scene_description.h"

namespace microinjection {
namespace {

/// Of what the data mean and how they are computed: to be raised when that changes.
constexpr int kVersion = 1;
constexpr double kPi = 3.14159265358979323846;
constexpr double kDegree = kPi / 180;
constexpr int kAngles = 5;

/// Where a direction leaves the cylinder of the range. `tilt` from the needle's axis and `turn` about it, degrees, with
/// depth and lateral motion as units.
Eigen::Vector3d border(const PreparationRange& range, double tilt, double turn) {
  const double side = std::sin(tilt * kDegree), down = std::cos(tilt * kDegree), length = 1 / std::max(side, down);
  return {length * side * std::cos(turn * kDegree) * range.lateral,
          length * side * std::sin(turn * kDegree) * range.lateral, -length * down * range.depth};
}

std::vector<Eigen::Vector3d> targets(const PreparationRange& range, bool on_axis) {
  std::vector<Eigen::Vector3d> result = {border(range, 0, 0)};
  const std::vector<std::pair<double, std::vector<double>>> cones = {
      {25, {0, 90, 180}}, {50, {45, 135}}, {72, {0, 90, 180}}, {85, {45, 135}}};
  for (const auto& [tilt, turns] : cones) {
    for (double turn : turns) {
      result.push_back(border(range, tilt, on_axis ? 0 : turn));
      if (on_axis) break;  // there all turns are the same
    }
  }
  return result;
}

}  // namespace

PreparationRange PreparationRange::standard(const Scene& scene) {
  return {60 * kDegree, 0.36 * scene.cell.diameter(), 0.09 * scene.cell.diameter()};
}

void Preparation::check(const Scene& scene) {
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (layer.material.viscoelasticity.empty()) continue;
    throw ConfigError("viscoelasticity of layer " + layer.name +
                      ": must be left out: only elastic cells can be prepared");
  }
  if (scene.needle.contact.friction > 0) {
    std::ostringstream message;
    message << "needle/contact/friction = " << scene.needle.contact.friction
            << ": must be 0, or the mode sticking: friction takes energy, and a prepared cell has none to give";
    throw ConfigError(message.str());
  }
}

Preparation Preparation::plan(const Scene& scene, const PreparationRange& range) {
  Preparation result;
  result.range = range;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = range.angle * i / (kAngles - 1);
    for (const Eigen::Vector3d& target : targets(range, i == 0)) {
      result.rays.push_back({angle, target, 2 * target.z() < -range.depth ? 14 : 12});
    }
  }
  std::stable_sort(result.rays.begin(), result.rays.end(),
                   [](const TrainingRay& a, const TrainingRay& b) { return a.target.z() < b.target.z(); });
  result.scales.angle = range.angle;
  result.scales.lateral = range.lateral;
  result.scales.depth = range.depth;
  result.scales.energy = scene.cell.material().young_modulus * scene.needle.tip.radius * range.depth * range.depth;
  return result;
}

std::string Preparation::description(const Scene& scene) const {
  std::ostringstream out;
  out << "prepared cell " << kVersion << ": " << describeCellAndTip(scene) << std::hexfloat << " to " << range.angle
      << ' ' << range.depth << ' ' << range.lateral;
  return out.str();
}

}  // namespace microinjection
