#include "cell/model/p1_cell.h"

#include <sstream>

#include "base/errors.h"
#include "cell/mesh/mesh_cache.h"
#include "cell/mesh/quadratic_mesh.h"
#include "cell/model/indentation.h"

namespace microinjection {
namespace {

TetMesh makeMesh(const Scene& scene) {
  scene.validate();
  const std::vector<std::string> refusals = P1Cell::refusals(scene);
  if (!refusals.empty()) throw ConfigError(refusals);
  const double tip = scene.needle.tip.radius, size = scene.meshSize();
  CellMeshConfig config;
  config.radii = scene.cell.outerRadii();
  config.size = size;
  config.stretch = scene.mesh.stretch;
  config.refinements = {{CellMeshConfig::Shape::kBall, scene.needle.offset, scene.mesh.refinement.zone * tip, +1,
                         size / scene.mesh.refinement.density}};
  config.imprints = {{scene.needle.offset, tip, +1},
                     {Eigen::Vector2d::Zero(), scene.holding_pipette.contact_radius, -1}};
  return MeshCache().get(config);
}

}  // namespace

std::vector<std::string> P1Cell::refusals(const Scene& scene) {
  constexpr char kNotLinear[] = " (not possible with linear tetrahedra)";
  std::vector<std::string> errors;
  if (scene.cell.tensegrity) errors.push_back(std::string("cell/model = tensegrity: must be continuum") + kNotLinear);
  if (scene.holding_pipette.mouth)
    errors.push_back(std::string("holding_pipette/mouth: must be left out") + kNotLinear);
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

P1Cell::P1Cell(const Scene& scene)
    : DiscContactCell(scene),
      mesh_(makeMesh(scene)),
      body_(std::make_shared<LayeredBody<3>>(makeQuadratic(mesh_, scene.cell.outerRadii()), ElementKind::kP1,
                                             scene.cell.makeMaterials())) {
  surface_ = extractSurface(mesh_);
  // Same rule as under the needle: the pipette's mouth is a disc below, along -z.
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  held_vertices_ = findTipPatch(surface_, scene.radius() * down, down, scene.holding_pipette.contact_radius).vertices;
}

std::string P1Cell::description() const {
  std::ostringstream text;
  text << "P1 tetrahedra, whose force is too large; " << mesh_.vertices.size() << " vertices, "
       << mesh_.tetrahedra.size() << " tetrahedra";
  return text.str();
}

std::unique_ptr<TipPath> P1Cell::path(const ContactPoint& contact_point) const {
  return std::make_unique<Indentation>(shared_from_this(), contact_point.patch);
}

}  // namespace microinjection
