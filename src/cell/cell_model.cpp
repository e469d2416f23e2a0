#include "cell/cell_model.h"

#include "base/errors.h"
#include "mesh/mesh_cache.h"

namespace microinjection {
namespace {

CellMeshConfig meshConfig(const Scene& scene) {
  scene.validate();
  CellMeshConfig config;
  config.diameter = scene.cell.diameter;
  config.size = scene.meshSize();
  config.density = scene.mesh.refinement.density;
  config.zone_diameter = scene.mesh.refinement.zone * 2 * scene.needle.tip.radius;
  config.tip_radius = scene.needle.tip.radius;
  config.offset = scene.needle.offset;
  config.contact_radius = scene.holding_pipette.contact_radius;
  return config;
}

}  // namespace

CellModel::CellModel(const Scene& scene)
    : scene_(scene), mesh_(MeshCache().get(meshConfig(scene))), surface_(extractSurface(mesh_)) {
  // The same rule as under the needle: the pipette's mouth is a disc below, along -z.
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  held_vertices_ = findTipPatch(surface_, scene.radius() * down, down, scene.holding_pipette.contact_radius).vertices;
  body_ = std::make_unique<const ElasticBody>(mesh_, makeMaterial(scene.cell.material));
}

std::optional<SurfaceHit> CellModel::hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                         int start) const {
  return castRayFrom(surface_, start, origin, direction);
}

TipPatch CellModel::patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const {
  return findTipPatch(surface_, point, axis, scene_.needle.tip.radius);
}

}  // namespace microinjection
