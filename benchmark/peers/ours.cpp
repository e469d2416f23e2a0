// This project's own models as a program of ./dev bench peers: reads a case, writes a result.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/atomic_file.h"
#include "benchmark/common/call_times.h"
#include "benchmark/common/paper_mesh.h"
#include "benchmark/common/surrogate_scene.h"
#include "benchmark/peers/peer_case.h"
#include "benchmark/peers/peer_result.h"
#include "cell/family/family_cell.h"
#include "cell/mechanics/explicit_step.h"
#include "cell/model/cell_problem.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families";
constexpr int kPlaces = 200;  ///< of the needle between two steps: one force takes microseconds
const Eigen::Vector3d kNoForce = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

/// Why a model does not serve a case.
class Declined : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <typename Solve>
void solveSteps(const PeerCase& peer_case, const Solve& solve, PeerResult& result) {
  for (const Eigen::Vector3d& displacement : peer_case.motion) {
    const double start = processTime();
    const Eigen::Vector3d force = solve(displacement);
    result.steps.push_back({force, processTime() - start});
  }
}

PaperCell linearCell(const PeerCase& peer_case) {
  PaperCell cell;
  cell.mesh.vertices = peer_case.nodes;
  for (const PeerCase::Element& element : peer_case.elements) {
    cell.mesh.tetrahedra.push_back({element.nodes[0], element.nodes[1], element.nodes[2], element.nodes[3]});
    cell.mesh.layers.push_back(element.layer);
  }
  cell.tip = peer_case.glued;
  cell.held = peer_case.held;
  return cell;
}

void solveLinear(const PeerCase& peer_case, const Scene& scene, PeerResult& result) {
  if (peer_case.layers.size() != 1 || peer_case.glued.empty()) throw Declined("homogeneous cells under a disc only");
  P1QuasiStatic solver(scene, linearCell(peer_case));
  solveSteps(
      peer_case,
      [&](const Eigen::Vector3d& displacement) { return Eigen::Vector3d(0, 0, solver.force(-displacement.z())); },
      result);
}

template <int Dim>
QuadraticMesh<Dim> quadraticMesh(const PeerCase& peer_case) {
  QuadraticMesh<Dim> mesh;
  for (const Eigen::Vector3d& node : peer_case.nodes) mesh.nodes.push_back(node.head<Dim>());
  mesh.vertex_count = peer_case.vertices;
  for (const PeerCase::Element& element : peer_case.elements) {
    mesh.elements.emplace_back();
    std::copy(element.nodes.begin(), element.nodes.end(), mesh.elements.back().begin());
    mesh.layers.push_back(element.layer);
  }
  for (const std::vector<int>& facet : peer_case.surface) {
    mesh.facets.emplace_back();
    std::copy(facet.begin(), facet.end(), mesh.facets.back().nodes.begin());
    mesh.facets.back().layer = 0;
  }
  return mesh;
}

template <int Dim>
void solveQuadratic(const PeerCase& peer_case, const Scene& scene, ElementKind element, PeerResult& result) {
  CellProblem<Dim> problem(scene, quadraticMesh<Dim>(peer_case), element);
  bool lost = false;
  solveSteps(
      peer_case,
      [&](const Eigen::Vector3d& displacement) -> Eigen::Vector3d {
        if (lost) return kNoForce;
        const IndentationSolution solution = problem.solve(displacement);
        lost = !solution.converged;
        return lost ? kNoForce : solution.force;
      },
      result);
}

void solveElements(const PeerCase& peer_case, const Scene& scene, const std::string& element, PeerResult& result) {
  result.model = "equilibrium";
  result.element = element;
  if (peer_case.order == 1) {
    if (element != "p1") throw Declined("the mesh is linear");
    solveLinear(peer_case, scene, result);
  } else if (peer_case.dimension == 2) {
    solveQuadratic<2>(peer_case, scene, elementKind(element), result);
  } else {
    solveQuadratic<3>(peer_case, scene, elementKind(element), result);
  }
}

/// The paper's central differences with the cell's own mass, until each step is at rest.
void solveExplicit(const PeerCase& peer_case, PeerResult& result) {
  constexpr int kRamp = 200;
  result.model = "paper's explicit dynamics, to rest";
  result.element = "p1";
  if (peer_case.order != 1 || peer_case.layers.size() != 1 || peer_case.layers[0].law != "st_venant_kirchhoff") {
    throw Declined("linear tetrahedra of one St-Venant-Kirchhoff layer only");
  }
  const PaperCell cell = linearCell(peer_case);
  ExplicitStepConfig config;
  config.lame = Lame::from(peer_case.layers[0].young_modulus, peer_case.layers[0].poisson_ratio);
  double lowest = 0;
  for (const Eigen::Vector3d& node : peer_case.nodes) lowest = std::min(lowest, node.z());
  // Critical for a shear wave of two diameters, the slowest that the held cell has.
  config.damping = 2 * M_PI * std::sqrt(config.lame.mu / config.density) / (-2 * lowest);
  config.held = cell.held;
  config.tip = cell.tip;
  ExplicitStep dynamics(cell.mesh, config);
  const int rest = static_cast<int>(150 / config.damping / dynamics.timeStep());
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  solveSteps(
      peer_case,
      [&](const Eigen::Vector3d& displacement) -> Eigen::Vector3d {
        for (int i = 1; i <= rest + kRamp; ++i) {
          dynamics.step(from + (displacement - from) * std::min(1.0, i / static_cast<double>(kRamp)));
        }
        from = displacement;
        return dynamics.hasInvertedElement() ? kNoForce : dynamics.force();
      },
      result);
}

std::shared_ptr<const SurrogateData> surrogate(const std::string& model, const Scene& scene, const std::string& file) {
  if (!scene.needle.tip.rounded()) throw Declined("rounded tips only");
  if (model == "surrogate") return std::make_shared<const SurrogateData>(surrogateScene(scene, file));
  std::string reason;
  const auto member = findFamilyCell(kFamilies, scene, reason);
  if (!member) throw Declined(reason.empty() ? "no family has this cell" : reason);
  return member->data;
}

/// The table of a surrogate cell or of a family's member: it has no mesh of its inside.
void solveSurrogate(const PeerCase& peer_case, const Scene& scene, const std::string& model, PeerResult& result) {
  result.model = model;
  result.element = "energy";
  SurrogateContact contact(scene, surrogate(model, scene, peer_case.scene));
  const Eigen::Vector3d touch(0, 0, scene.radius());
  contact.step(touch + Eigen::Vector3d(0, 0, 1e-9));
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& displacement : peer_case.motion) {
    SurrogateContact::Result last;
    const double start = processTime();
    for (int i = 1; i <= kPlaces; ++i) {
      last = contact.step(touch + from + (displacement - from) * (i / static_cast<double>(kPlaces)));
    }
    const double time = (processTime() - start) / kPlaces;
    result.steps.push_back({last.prepared && !last.too_deep ? last.force : kNoForce, time});
    from = displacement;
  }
}

PeerResult solve(const std::string& model, const PeerCase& peer_case) {
  PeerResult result;
  result.program = "cell_microinjection";
  result.model = model;
  result.element = "-";
  result.law = "same";
  const Scene scene = loadScene(peer_case.scene);
  const auto& elements = elementNames();
  try {
    if (model == "explicit") {
      solveExplicit(peer_case, result);
    } else if (model == "surrogate" || model == "family") {
      solveSurrogate(peer_case, scene, model, result);
    } else if (std::find(elements.begin(), elements.end(), model) != elements.end()) {
      solveElements(peer_case, scene, model, result);
    } else {
      throw std::runtime_error("MODEL must be an element (p1, p2, p2_p0, ...), explicit, family or surrogate");
    }
  } catch (const Declined& reason) {
    result.declined = reason.what();
  }
  return result;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: " << argv[0] << " MODEL CASE RESULT\n";
    return 2;
  }
  try {
    const microinjection::PeerResult result = microinjection::solve(argv[1], microinjection::readPeerCase(argv[2]));
    microinjection::writeFileAtomically(argv[3], microinjection::peerResultText(result));
    return 0;
  } catch (const std::exception& exception) {
    std::cerr << argv[0] << ": " << exception.what() << '\n';
    return 2;
  }
}
