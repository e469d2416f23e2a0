#include "cell/cell_model.h"

#include <algorithm>
#include <sstream>

#include "base/errors.h"
#include "cell/indentation.h"
#include "mesh/mesh_cache.h"
#include "mesh/quadratic_mesh.h"

namespace microinjection {
namespace {

std::vector<double> outerRadii(const Scene& scene) {
  std::vector<double> radii;
  for (const Scene::Layer& layer : scene.cell.layers) radii.push_back(layer.outer_radius);
  return radii;
}

TetMesh makeMesh(const Scene& scene) {
  scene.validate();
  const std::vector<std::string> refusals = CellModel::refusals(scene);
  if (!refusals.empty()) throw ConfigError(refusals);
  const double tip = scene.needle.tip.radius, size = scene.meshSize();
  CellMeshConfig config;
  config.radii = outerRadii(scene);
  config.size = size;
  config.stretch = scene.mesh.stretch;
  config.refinements = {{CellMeshConfig::Shape::kBall, scene.needle.offset, scene.mesh.refinement.zone * tip, +1,
                         size / scene.mesh.refinement.density}};
  config.imprints = {{scene.needle.offset, tip, +1},
                     {Eigen::Vector2d::Zero(), scene.holding_pipette.contact_radius, -1}};
  return MeshCache().get(config);
}

LayeredBody<3>::Materials makeMaterials(const Scene& scene) {
  LayeredBody<3>::Materials materials;
  for (const Scene::Layer& layer : scene.cell.layers) materials.push_back(makeMaterial(layer.material));
  return materials;
}

}  // namespace

std::vector<std::string> CellModel::refusals(const Scene& scene) {
  constexpr char kNotLinear[] = " (linear tetrahedra do not do it)";
  std::vector<std::string> errors;
  if (scene.needle.tip.shape != "disc") {
    errors.push_back("needle/tip/shape = " + scene.needle.tip.shape + ": must be disc" + kNotLinear);
  }
  const std::vector<Scene::Layer>& layers = scene.cell.layers;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string path = layers.size() == 1 ? "cell/" : "cell/layers/" + std::to_string(i) + "/";
    if (layers[i].surface_tension > 0) {
      std::ostringstream message;
      message << path << "surface_tension = " << layers[i].surface_tension << " N/m: must be 0" << kNotLinear;
      errors.push_back(message.str());
    }
    if (!layers[i].material.viscoelasticity.empty()) {
      errors.push_back(path + "material/viscoelasticity: must be left out" + kNotLinear);
    }
  }
  return errors;
}

CellModel::CellModel(const Scene& scene)
    : scene_(scene),
      mesh_(makeMesh(scene)),
      surface_(extractSurface(mesh_)),
      body_(std::make_shared<LayeredBody<3>>(makeQuadratic(mesh_, outerRadii(scene)), ElementKind::kP1,
                                             makeMaterials(scene))) {
  // The same rule as under the needle: the pipette's mouth is a disc below, along -z.
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  held_vertices_ = findTipPatch(surface_, scene.radius() * down, down, scene.holding_pipette.contact_radius).vertices;
}

std::optional<SurfaceHit> CellModel::hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                         int start) const {
  return castRayFrom(surface_, start, origin, direction);
}

TipPatch CellModel::patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const {
  return findTipPatch(surface_, point, axis, scene_.needle.tip.radius);
}

std::string CellModel::description() const {
  std::ostringstream text;
  text << "P1 tetrahedra, whose force is too large; " << mesh_.vertices.size() << " vertices, "
       << mesh_.tetrahedra.size() << " tetrahedra";
  return text.str();
}

std::optional<Eigen::Vector3d> CellModel::touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                                int& hint) const {
  const double outside = 2 * scene_.cell.diameter();
  const Eigen::Vector3d origin = tip + (outside + tip.norm()) * axis;  // from outside, wherever the tip is
  const auto found = hit(origin, -axis, hint);
  if (!found) return std::nullopt;
  hint = found->triangle;
  return found->point;
}

bool CellModel::isOff(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                      const Eigen::Vector3d& touched_at) const {
  return (tip - touched_at).dot(axis) > 0;
}

TipPlace CellModel::placeAt(const Eigen::Vector3d& touched_at, const Eigen::Vector3d& axis) const {
  return {touched_at, patchAt(touched_at, axis)};
}

std::unique_ptr<TipPath> CellModel::path(const TipPlace& place) const {
  return std::make_unique<Indentation>(shared_from_this(), place.patch);
}

LiveCell::Surface CellModel::surfaceAtRest() const {
  return {surface_.vertices, surface_.triangles, onSurface({held_vertices_})};
}

std::vector<std::uint32_t> CellModel::onSurface(const TipPatch& patch) const {
  std::vector<std::uint32_t> result;
  for (const int vertex : patch.vertices) {
    const auto found = std::lower_bound(surface_.mesh_vertices.begin(), surface_.mesh_vertices.end(), vertex);
    if (found != surface_.mesh_vertices.end() && *found == vertex)
      result.push_back(static_cast<std::uint32_t>(found - surface_.mesh_vertices.begin()));
  }
  return result;
}

}  // namespace microinjection
