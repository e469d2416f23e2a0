#include "cell/model/scene_mesh.h"

#include <algorithm>
#include <cmath>

#include "cell/contact/pipette_mouth.h"
#include "cell/contact/rounded_tip.h"
#include "cell/mesh/section_mesher.h"
#include "cell/mesh/swept_mesh.h"

namespace microinjection {
namespace {

constexpr double kGrowth = 0.25;  ///< of the elements' size per distance from the needle's edge
constexpr int kSegments = 8;      ///< around the needle, level 0
constexpr int kFewestSegments = 6;
constexpr double kLipReach = 2;  ///< of the finest elements about the lip, over its edge radius

/// Size of the elements far from the needle, m. They matter less and are refined more slowly.
double farSize(const Scene& scene, double level) { return scene.radius() / 6 * std::pow(2, -0.5 * level); }

/// Element size at the edge of the holding pipette, m. The stress is singular there, too, but far
/// from the needle.
double holdingSize(const Scene& scene, double level) {
  return 0.25 * scene.holding_pipette.contact_radius * std::pow(2, -level);
}

/// Radius about the contact point within which the surface may touch the tip's end or its shaft, m.
double contactReach(const Scene& scene) { return 1.4 * scene.needle.tip.radius; }

SectionMeshConfig sectionConfig(const Scene& scene, double level) {
  SectionMeshConfig config;
  config.radii = scene.cell.outerRadii();
  config.size = farSize(scene, level);
  config.growth = kGrowth;
  if (const std::optional<Scene::Mouth>& mouth = scene.holding_pipette.mouth) {
    // The surface bends about the lip, slides over it, and comes to lie against the bore as the tongue grows.
    const PipetteMouth lip(mouth->inner_radius, mouth->outer_radius, mouth->edge_radius, -1);
    config.refinements = {{lip.touchRadius(scene.radius()), -1, kLipReach * mouth->edge_radius,
                           mouth->edge_radius / 4 * std::pow(2, -level)}};
  } else {
    config.vertices = {{scene.holding_pipette.contact_radius, -1}};
    config.refinements = {{scene.holding_pipette.contact_radius, -1, 0, holdingSize(scene, level)}};
  }
  const double edge = edgeSize(scene, level), radius = scene.needle.tip.radius;
  if (scene.needle.tip.rounded()) {
    config.refinements.push_back({0, +1, contactReach(scene), edge});
  } else {
    config.vertices.push_back({radius, +1});
    config.refinements.push_back({radius, +1, 0, edge});
  }
  return config;
}

/// Position (x, y) on the cell's surface about which the mesh is ordered, m.
Eigen::Vector2d pole(const Scene& scene) {
  const Scene::Needle& needle = scene.needle;
  if (!needle.tip.rounded()) return needle.offset;
  const RoundedTip tip = RoundedTip::make(needle.tip.shape, needle.tip.radius, needle.tip.edge_radius);
  return tip.touchPoint(scene.radius(), needle.offset).head<2>();
}

}  // namespace

double edgeSize(const Scene& scene, double level) {
  const Scene::Tip& tip = scene.needle.tip;
  const double coarsest = tip.rounded() ? std::min(tip.radius / 4, tip.edgeRadius() / 2) : tip.radius / 2;
  return coarsest * std::pow(2, -level);
}

bool isAxisymmetric(const Scene& scene) { return scene.needle.offset.isZero(0); }

template <>
QuadraticMesh<2> makeSceneMesh<2>(const Scene& scene, double level) {
  const SectionMeshConfig config = sectionConfig(scene, level);
  return makeQuadratic(makeSectionMesh(config), config.radii);
}

namespace {

QuadraticMesh<3> sweep(const Scene& scene, const QuadraticMesh<2>& section, double level, bool half) {
  const Eigen::Vector2d contact_point = pole(scene);
  SweepConfig config;
  config.half = half;
  config.segments = std::max(kFewestSegments, static_cast<int>(std::lround(kSegments + 4 * level)));
  config.pole_offset = contact_point.norm();
  config.pole_azimuth = contact_point.isZero(0) ? 0 : std::atan2(contact_point.y(), contact_point.x());
  config.disc_radius = scene.needle.tip.rounded() ? 0 : scene.needle.tip.radius;
  config.holding_radius = scene.holding_pipette.contact_radius;
  if (half) config.segments = (config.segments + 1) / 2;
  return sweepSection(section, config);
}

}  // namespace

QuadraticMesh<3> sweepScene(const Scene& scene, const QuadraticMesh<2>& section, double level) {
  return sweep(scene, section, level, false);
}

template <>
QuadraticMesh<3> makeSceneMesh<3>(const Scene& scene, double level) {
  return sweepScene(scene, makeSceneMesh<2>(scene, level), level);
}

QuadraticMesh<3> makeHalfSceneMesh(const Scene& scene, double level) {
  return sweep(scene, makeSceneMesh<2>(scene, level), level, true);
}

}  // namespace microinjection
