#include "bench/common/paper_mesh.h"

#include <limits>
#include <string>

#include "contact/tip_patch.h"
#include "mechanics/layered_body.h"
#include "mesh/mesh_cache.h"
#include "mesh/surface_mesh.h"

namespace microinjection {

const std::vector<PaperMesh>& paperMeshes() {
  static const std::vector<PaperMesh> meshes = {
      {115, 332, 12.1e-6, 1.6, false}, {165, 546, 10.06e-6, 1, false}, {282, 1019, 25.8e-6, 5, true},
      {346, 1269, 21.2e-6, 5, true},   {516, 2130, 16.3e-6, 5, true},  {731, 3060, 13.8e-6, 5, true},
      {1093, 4819, 11.15e-6, 5, true},
  };
  return meshes;
}

P1Cell makeP1Cell(const Scene& scene, const PaperMesh& mesh) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double tip = scene.needle.tip.radius, zone = mesh.circles ? scene.mesh.refinement.zone * tip : 0;
  CellMeshConfig config;
  config.radii = {scene.radius()};
  config.size = mesh.size;
  config.refinements = {{CellMeshConfig::Shape::kBall, {0, 0}, zone, +1, mesh.size / mesh.density}};
  if (mesh.circles) config.imprints = {{{0, 0}, tip, +1}, {{0, 0}, scene.holding_pipette.contact_radius, -1}};
  P1Cell cell;
  cell.mesh = MeshCache().get(config);
  const SurfaceMesh surface = extractSurface(cell.mesh);
  cell.tip = findTipPatch(surface, scene.radius() * up, up, tip).vertices;
  cell.held = findTipPatch(surface, -scene.radius() * up, -up, scene.holding_pipette.contact_radius).vertices;
  return cell;
}

P1QuasiStatic::P1QuasiStatic(const Scene& scene, const P1Cell& cell) {
  const auto body =
      std::make_shared<LayeredBody<3>>(makeQuadratic(cell.mesh, std::vector<double>{scene.radius()}), ElementKind::kP1,
                                       LayeredBody<3>::Materials{makeMaterial(scene.cell.material())});
  Constraints constraints;
  constraints.entries.assign(body->stateSize(), Constraints::kFree);
  for (int k = 0; k < 3; ++k) {
    for (int v : cell.held) constraints.entries[3 * v + k] = Constraints::kFixed;
    for (int v : cell.tip) constraints.entries[3 * v + k] = Constraints::tip(k);
    constraints.entries[body->tipEntry() + k] = Constraints::tip(k);
  }
  system_ = std::make_unique<EquilibriumSystem>(EquilibriumSystem::Terms{body}, constraints,
                                                SymmetricSolver::Method::kSimplicial);
  LoadPathConfig config;
  config.length = scene.cell.diameter();
  config.first_step = config.largest_step = config.length / 16;
  config.smallest_step = config.length * 1e-5;
  config.linear = body->isLinear();
  path_ = std::make_unique<LoadPath>(*system_, config);
}

double P1QuasiStatic::force(double depth) {
  const bool converged = path_->advance({0, 0, -depth}).converged;
  return converged ? -path_->reaction().z() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace microinjection
