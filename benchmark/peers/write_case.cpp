// Writes a case of ./dev bench peers: the mesh of a scene and a motion of its tip.

#include <boost/program_options.hpp>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "benchmark/common/paper_mesh.h"
#include "benchmark/peers/peer_case.h"
#include "cell/contact/rounded_tip.h"
#include "cell/material/material_parameter.h"
#include "cell/mesh/surface_mesh.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kOnCircle = 1 + 1e-9;

template <int Dim>
double distanceFromAxis(const Eigen::Matrix<double, Dim, 1>& node) {
  return node.template head<Dim - 1>().norm();
}

/// The nodes of the facets of the outer surface that lie within `radius` of the axis on one side.
template <int Dim>
std::vector<int> nodesWithin(const QuadraticMesh<Dim>& mesh, double radius, double side) {
  std::vector<char> inside(mesh.nodes.size(), 0);
  for (const auto& facet : mesh.facets) {
    bool all = facet.layer == 0;
    for (int corner = 0; corner < Dim; ++corner) {
      const auto& node = mesh.nodes[facet.nodes[corner]];
      all = all && side * node[Dim - 1] > 0 && distanceFromAxis<Dim>(node) <= kOnCircle * radius;
    }
    for (const int node : facet.nodes) inside[node] |= all;
  }
  std::vector<int> result;
  for (std::size_t node = 0; node < inside.size(); ++node) {
    if (inside[node]) result.push_back(static_cast<int>(node));
  }
  return result;
}

template <int Dim>
void addQuadraticMesh(const Scene& scene, double level, PeerCase& result) {
  const QuadraticMesh<Dim> mesh = makeSceneMesh<Dim>(scene, level);
  result.dimension = Dim;
  result.order = 2;
  result.vertices = mesh.vertex_count;
  for (const auto& node : mesh.nodes) {
    result.nodes.emplace_back(Eigen::Vector3d::Zero());
    result.nodes.back().head<Dim>() = node;
  }
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    result.elements.push_back({mesh.layers[e], {mesh.elements[e].begin(), mesh.elements[e].end()}});
  }
  for (const auto& facet : mesh.facets) {
    if (facet.layer == 0) result.surface.emplace_back(facet.nodes.begin(), facet.nodes.end());
  }
  result.held = nodesWithin(mesh, scene.holding_pipette.contact_radius, -1);
  if (!scene.needle.tip.rounded()) result.glued = nodesWithin(mesh, scene.needle.tip.radius, +1);
}

void addPaperMesh(const Scene& scene, int row, PeerCase& result) {
  if (scene.cell.layers.size() != 1 || scene.needle.tip.rounded()) {
    throw std::runtime_error("a mesh of the paper is for a homogeneous cell under a disc");
  }
  const PaperCell cell = makePaperCell(scene, paperMeshes().at(row));
  result.dimension = 3;
  result.order = 1;
  result.nodes = cell.mesh.vertices;
  result.vertices = static_cast<int>(cell.mesh.vertices.size());
  for (const auto& corners : cell.mesh.tetrahedra) result.elements.push_back({0, {corners.begin(), corners.end()}});
  const SurfaceMesh surface = extractSurface(cell.mesh);
  for (const auto& triangle : surface.triangles) {
    result.surface.emplace_back();
    for (const int v : triangle) result.surface.back().push_back(surface.mesh_vertices[v]);
  }
  result.held = cell.held;
  result.glued = cell.tip;
}

PeerCase makeCase(const std::string& scene_file, const std::string& mesh, double level, const std::string& depths) {
  const Scene scene = loadScene(scene_file);
  scene.requireContinuum("a case for other programs");
  if (!isAxisymmetric(scene)) throw std::runtime_error("the needle's offset must be zero");
  PeerCase result;
  result.scene = scene_file;
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (layer.surface_tension != 0 || !layer.material.viscoelasticity.empty()) {
      throw std::runtime_error("surface tension and viscoelasticity are not part of the format");
    }
    for (const MaterialParameter& each : materialParameters()) {
      if (!each.ofAllModels() && layer.material.*each.value != MaterialConfig().*each.value)
        throw std::runtime_error(std::string(each.name) + " is not part of the format");
    }
    result.layers.push_back({layer.material.model, layer.material.young_modulus, layer.material.poisson_ratio});
  }
  if (mesh == "paper") {
    addPaperMesh(scene, static_cast<int>(std::lround(level)), result);
  } else if (mesh == "section") {
    addQuadraticMesh<2>(scene, level, result);
  } else if (mesh == "space") {
    addQuadraticMesh<3>(scene, level, result);
  } else {
    throw std::runtime_error("--mesh must be paper, section or space");
  }
  const Scene::Tip& tip = scene.needle.tip;
  const double height =
      tip.rounded()
          ? RoundedTip::make(tip.shape, tip.radius, tip.edge_radius).touchHeight(scene.radius(), scene.needle.offset)
          : scene.radius();
  result.tip = {tip.shape, scene.needle.contact.mode, tip.radius, height};
  std::istringstream list(depths);
  for (std::string depth; std::getline(list, depth, ',');) result.motion.emplace_back(0, 0, -std::stod(depth));
  return result;
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string scene, mesh, depths, out;
  double level = 0;
  po::options_description options("peer_case: writes a case of ./dev bench peers\nOptions");
  options.add_options()("help", "this text")("scene", po::value(&scene)->required(), "scene file")(
      "mesh", po::value(&mesh)->required(), "paper, section or space")(
      "level", po::value(&level)->default_value(0), "of refinement; of paper: row of its table, from 0")(
      "depths", po::value(&depths)->required(), "m, of each step, separated by commas")(
      "out", po::value(&out)->required(), "file of the case");
  po::variables_map values;
  const po::positional_options_description none;
  po::store(po::command_line_parser(argc, argv).options(options).positional(none).run(), values);
  if (values.count("help") != 0) {
    std::cout << options;
    return 0;
  }
  po::notify(values);
  writeFileAtomically(out, peerCaseText(makeCase(scene, mesh, level, depths)));
  return 0;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& exception) {
    std::cerr << argv[0] << ": " << exception.what() << '\n';
    return 2;
  }
}
