#include "cell/surrogate/surrogate_plan.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "cell/model/scene_description.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

/// Version of the data and their computation: increase it when these change.
constexpr int kVersion = 5;
constexpr double kDegree = M_PI / 180;
constexpr int kAngles = 4;
constexpr int kPoints = 12;  ///< along a path as long as the range is deep
constexpr int kFewest = 8;
/// Smallest overlap of a path's end with the cell, over the cell's radius: less only grazes it.
constexpr double kOverlap = 0.012;

/// Point at which a direction leaves the cylinder of the range. `tilt` from the needle's axis and
/// `turn` about it, degrees.
Eigen::Vector3d border(const SurrogateRange& range, double tilt, double turn) {
  const double side = std::sin(tilt * kDegree), down = std::cos(tilt * kDegree);
  const double length = 1 / std::max(side / range.lateral, down / range.depth);
  const double across = turn == 180 ? 0 : std::sin(turn * kDegree);  // exactly zero, for symmetry
  return length * Eigen::Vector3d(side * std::cos(turn * kDegree), side * across, -down);
}

struct Target {
  Eigen::Vector3d end;  ///< m
  bool fine;            ///< also solved on the fine mesh, if in the plane of symmetry
};

/// `index`: of the contact angle, 0 on the axis.
std::vector<Target> targets(const SurrogateRange& range, int index, PathSet paths) {
  struct Cone {
    double tilt;                ///< degrees
    std::vector<double> turns;  ///< degrees
    bool fine;
    bool fine_of_few;  ///< also when few paths are wanted
  };
  const std::vector<Cone> cones = {{12, {0, 180}, false, false},
                                   {24, {0, 90, 180}, true, false},
                                   {38, {0, 60, 120, 180}, true, false},
                                   {55, {0, 90, 180}, true, true},
                                   {72, {0, 60, 120, 180}, false, false}};
  const bool on_axis = index == 0, few = paths == PathSet::kFew;
  std::vector<Target> result = {{border(range, 0, 0), !on_axis}};  // on the axis the section is finer
  for (const Cone& cone : cones) {
    const bool fine = few ? cone.fine_of_few && !on_axis : cone.fine;
    for (double turn : cone.turns) {
      const Eigen::Vector3d end = border(range, cone.tilt, on_axis ? 0 : turn);
      const bool in_plane = end.y() == 0;
      if (in_plane || !few || index > 1) result.push_back({end, fine && in_plane});
      if (on_axis) break;  // all turns are equal there
    }
  }
  return result;
}

/// Whether the target still overlaps with the cell.
bool keepsContact(const Scene& scene, double angle, const Eigen::Vector3d& target) {
  const double reach = scene.radius() + (scene.needle.tip.rounded() ? scene.needle.tip.radius : 0);
  const Eigen::Vector3d centre = reach * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)) + target;
  return reach - centre.norm() > kOverlap * scene.radius() || centre.z() < 0;
}

/// Approximate cost of a path, in units of the coarse mesh's half per point.
double cost(const TrainingRay& ray) {
  const double whole = ray.target.y() == 0 ? 1 : 4.5, fine = ray.level == kFineLevel ? 5 : 1;
  return whole * fine * ray.points;
}

bool isLinear(const Scene::Cell& cell) {
  return std::all_of(cell.layers.begin(), cell.layers.end(), [](const Scene::Layer& layer) {
    return layer.material.model == "linear" && layer.surface_tension == 0;
  });
}

bool relaxesAlike(const PronyTerm& a, const PronyTerm& b) {
  return a.modulus_ratio == b.modulus_ratio && a.relaxation_time == b.relaxation_time;
}

}  // namespace

SurrogateRange SurrogateRange::standard(const Scene& scene) {
  const double diameter = scene.cell.diameter();
  return {60 * kDegree, 0.36 * diameter, 0.805 * diameter, 0.09 * diameter};
}

SurrogateRange SurrogateRange::scaled(double factor) const {
  return {angle, factor * depth, factor * axis_depth, factor * lateral};
}

void SurrogatePlan::check(const Scene& scene) {
  if (scene.cell.tensegrity) {
    throw ConfigError(
        "cell/model = tensegrity: must be continuum: a surrogate cell is one of revolution about the holding "
        "pipette's axis, and a tensegrity cell is not; it is solved live");
  }
  scene.requireGlued("a surrogate cell");
  if (!scene.needle.tip.rounded() && !isLinear(scene.cell)) {
    throw ConfigError(
        "needle/tip/shape = disc: must be hemisphere or rounded_flat, or the cell's material linear and without "
        "tension: under a sharp edge the surface folds");
  }
  const std::vector<PronyTerm>& first = scene.cell.layers.front().material.viscoelasticity.prony;
  for (const Scene::Layer& layer : scene.cell.layers) {
    const ViscoelasticityConfig& own = layer.material.viscoelasticity;
    if (own.viscosity > 0) {
      throw ConfigError("viscoelasticity/viscosity of layer " + layer.name +
                        ": must be left out: a surrogate cell's memory is of Prony terms only");
    }
    const bool same = std::equal(own.prony.begin(), own.prony.end(), first.begin(), first.end(), relaxesAlike);
    if (same) continue;
    throw ConfigError("viscoelasticity of layer " + layer.name +
                      ": must be that of the other layers: a surrogate cell relaxes as a whole");
  }
  if (scene.needle.contact.adhesion_energy > 0) {
    throw ConfigError("needle/contact/adhesion: must be left out: a surrogate cell has no contact history");
  }
}

Scene SurrogatePlan::elastic(const Scene& scene) {
  Scene result = scene;
  for (Scene::Layer& layer : result.cell.layers) layer.material.viscoelasticity = ViscoelasticityConfig();
  return result;
}

std::vector<TrainingRay> SurrogatePlan::paths(const SurrogateRange& range, PathSet paths) {
  std::vector<TrainingRay> rays;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = range.angle * i / (kAngles - 1);
    for (const auto& [target, fine] : targets(range, i, paths)) {
      const int points = static_cast<int>(std::lround(kPoints * std::sqrt(target.norm() / range.depth)));
      rays.push_back({angle, target, std::max(points, kFewest), kCoarseLevel});
      if (!fine) continue;
      rays.push_back(rays.back());
      rays.back().level = kFineLevel;
    }
  }
  return rays;
}

SurrogatePlan SurrogatePlan::plan(const Scene& scene, const SurrogateRange& range, PathSet paths) {
  SurrogatePlan result;
  result.range = range;
  for (const TrainingRay& ray : SurrogatePlan::paths(range, paths)) {
    if (keepsContact(scene, ray.angle, ray.target)) result.rays.push_back(ray);
  }
  std::stable_sort(result.rays.begin(), result.rays.end(),
                   [](const TrainingRay& a, const TrainingRay& b) { return cost(a) > cost(b); });
  result.scales.angle = range.angle;
  result.scales.length = range.axis_depth;
  result.scales.energy = scene.cell.material().young_modulus * scene.needle.tip.radius * range.depth * range.depth;
  return result;
}

std::string SurrogatePlan::description(const Scene& scene, const TrainingRay& ray) const {
  std::ostringstream out;
  out << description(scene) << " path " << std::hexfloat << ray.angle;
  for (const double x : ray.target) out << ' ' << rounded(x / scene.radius());
  out << ' ' << ray.points << " level " << ray.level;
  return out.str();
}

std::string SurrogatePlan::description(const Scene& scene) const {
  std::ostringstream out;
  // The words are a part of the identity: stored data, also those of the shipped families, have them.
  out << "prepared cell " << kVersion << ": " << describeCellAndTip(withoutDimension(elastic(scene))) << std::hexfloat
      << " to " << range.angle;
  for (const double length : {range.depth, range.axis_depth, range.lateral}) {
    out << ' ' << rounded(length / scene.radius());
  }
  return out.str();
}

}  // namespace microinjection
