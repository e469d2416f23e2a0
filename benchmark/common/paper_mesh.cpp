#include "benchmark/common/paper_mesh.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "cell/contact/tip_patch.h"
#include "cell/mesh/mesh_cache.h"
#include "cell/mesh/surface_mesh.h"

namespace microinjection {

const std::vector<PaperMesh>& paperMeshes() {
  static const std::vector<PaperMesh> meshes = {
      {115, 332, 41.42e-6, 1, true},     {123, 379, 36.66e-6, 1.0 / 3, false}, {128, 407, 29.6e-6, 0.6, false},
      {165, 546, 26.2e-6, 1, true},      {176, 614, 24.65e-6, 1, true},        {192, 672, 24.65e-6, 0.8, true},
      {271, 979, 19.31e-6, 0.8, true},   {282, 1019, 22.49e-6, 0.45, true},    {346, 1269, 21.16e-6, 1.0 / 3, true},
      {516, 2130, 15.12e-6, 0.45, true}, {731, 3060, 13.8e-6, 1.0 / 3, true},  {1093, 4819, 10.17e-6, 0.6, true},
  };
  return meshes;
}

namespace {

/// The corners of the surface nearest to a point.
std::vector<int> nearestVertices(const SurfaceMesh& surface, const Eigen::Vector3d& point, std::size_t count) {
  std::vector<std::pair<double, int>> found;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    found.emplace_back((surface.vertices[v] - point).norm(), surface.mesh_vertices[v]);
  }
  std::sort(found.begin(), found.end());
  std::vector<int> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(found[i].second);
  return result;
}

}  // namespace

PaperCell makePaperCell(const Scene& scene, const PaperMesh& mesh) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Scene::Refinement& refinement = scene.mesh.refinement;
  const double tip = scene.needle.tip.radius, zone = refinement.zone * tip;
  CellMeshConfig config;
  config.radii = {scene.radius()};
  config.size = mesh.size;
  config.refinements = {{CellMeshConfig::Shape::kBall, {0, 0}, zone, +1, mesh.size / refinement.density}};
  config.growth = mesh.growth;
  config.stretch = mesh.stretch;
  if (mesh.circles) config.imprints = {{{0, 0}, tip, +1}, {{0, 0}, scene.holding_pipette.contact_radius, -1}};
  PaperCell cell;
  cell.mesh = MeshCache().get(config);
  const SurfaceMesh surface = extractSurface(cell.mesh);
  cell.tip = findTipPatch(surface, scene.radius() * up, up, tip).vertices;
  cell.held = findTipPatch(surface, -scene.radius() * up, -up, scene.holding_pipette.contact_radius).vertices;
  // Held by two, it could still turn.
  if (cell.held.size() < 3) cell.held = nearestVertices(surface, -scene.radius() * up, 3);
  return cell;
}

P1QuasiStatic::P1QuasiStatic(const Scene& scene, const PaperCell& cell)
    : body_(std::make_shared<LayeredBody<3>>(makeQuadratic(cell.mesh, std::vector<double>{scene.radius()}),
                                             ElementKind::kP1,
                                             LayeredBody<3>::Materials{makeMaterial(scene.cell.material())})) {
  Constraints constraints;
  constraints.entries.assign(body_->stateSize(), Constraints::kFree);
  for (int k = 0; k < 3; ++k) {
    for (int v : cell.held) constraints.entries[3 * v + k] = Constraints::kFixed;
    for (int v : cell.tip) constraints.entries[3 * v + k] = Constraints::tip(k);
    constraints.entries[body_->tipEntry() + k] = Constraints::tip(k);
  }
  system_ = std::make_unique<EquilibriumSystem>(EquilibriumSystem::Terms{body_}, constraints,
                                                SymmetricSolver::Method::kSimplicial);
  LoadPathConfig config;
  config.length = scene.cell.diameter();
  config.first_step = config.largest_step = config.length / 16;
  config.smallest_step = config.length * 1e-5;
  config.linear = body_->isLinear();
  path_ = std::make_unique<LoadPath>(*system_, config);
}

double P1QuasiStatic::force(double depth) {
  const bool converged = path_->advance({0, 0, -depth}).converged;
  return converged ? -path_->reaction().z() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace microinjection
