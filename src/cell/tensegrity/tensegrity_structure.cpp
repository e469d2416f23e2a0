#include "cell/tensegrity/tensegrity_structure.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cell/mechanics/relaxation.h"
#include "cell/tensegrity/geodesic_sphere.h"
#include "cell/tensegrity/spin_stop.h"
#include "cell/tensegrity/strut_mesh.h"

namespace microinjection {
namespace {

constexpr double kSpin = 1e-4;  ///< moment against spinning, over the strut's bending stiffness per length

/// The same mesh with straight quadratic elements.
QuadraticMesh<3> straight(const TetMesh& mesh) {
  return makeQuadratic(mesh,
                       [&](int a, int b) -> Eigen::Vector3d { return 0.5 * (mesh.vertices[a] + mesh.vertices[b]); });
}

constexpr double kTolerance = 1e-9;  ///< residual, over the prestress
constexpr double kRounding = 2e-15;  ///< of a strut's stress, over Young's modulus
constexpr int kFactorisations = 80;  ///< of a relaxation, before the prestress is applied in smaller steps
constexpr int kMostWorseSteps = 6;   ///< successive Newton steps without improvement before it stops
constexpr double kSmallestPrestressStep = 1.0 / 64;  ///< of the prestress

}  // namespace

TensegrityStructure::TensegrityStructure(const TensegrityConfig& config)
    : config_((config.validate(), config)), geometry_(config), node_positions_(std::make_shared<NodePositions>()) {
  const Eigen::VectorXd displacement = makeStruts();
  makeMembrane();
  start_ = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(node_positions_->size()) + 3);
  start_.head(displacement.size()) = displacement;
  initial_ = start_;
  findForm();
  makeSurface();
}

/// Makes the struts without load, longer than in the structure. Returns the displacement that
/// shortens them to it.
Eigen::VectorXd TensegrityStructure::makeStruts() {
  const FilamentConfig& filaments = config_.microtubules.filaments;
  const double strain = geometry_.strut_force / filaments.axialStiffness();
  if (!(strain < 0.5)) {
    throw std::runtime_error(
        "the cables' prestress would shorten the struts by half or more: more microtubules, or "
        "less prestrain");
  }
  StrutMeshConfig mesh_config;
  mesh_config.length = geometry_.strut_length / (1 - strain);
  mesh_config.section = filaments.section();
  mesh_config.slices = config_.microtubules.slices;
  mesh_config.bow = config_.microtubules.bow;
  TetMesh all;
  std::vector<Eigen::Vector3d> along, middle;  // of each vertex's strut
  ends_.resize(12);
  for (const auto& [a, b] : geometry_.struts) {
    const Eigen::Vector3d centre = 0.5 * (geometry_.ends[a] + geometry_.ends[b]);
    const Eigen::Vector3d direction = (geometry_.ends[b] - geometry_.ends[a]).normalized();
    const StrutMesh strut(mesh_config, centre - 0.5 * mesh_config.length * direction, direction, centre);
    const int first = static_cast<int>(all.vertices.size());
    ends_[a] = first + strut.firstApex();
    ends_[b] = first + strut.lastApex();
    std::vector<int> firsts, section;
    for (int slice = 0; slice <= mesh_config.slices; ++slice) firsts.push_back(first + strut.vertex(slice, 0));
    for (int corner = 0; corner < StrutMesh::kCorners; ++corner) {
      section.push_back(first + strut.vertex(mesh_config.slices / 2, corner));
    }
    sections_.push_back(firsts);
    middles_.push_back(section);
    all.vertices.insert(all.vertices.end(), strut.mesh.vertices.begin(), strut.mesh.vertices.end());
    for (std::array<int, 4> corners : strut.mesh.tetrahedra) {
      for (int& corner : corners) corner += first;
      all.tetrahedra.push_back(corners);
    }
    along.resize(all.vertices.size(), direction);
    middle.resize(all.vertices.size(), centre);
  }
  all.layers.assign(all.tetrahedra.size(), 0);
  MaterialConfig material;
  material.model = config_.microtubules.model;
  material.young_modulus = filaments.young_modulus;
  material.poisson_ratio = config_.microtubules.poisson_ratio;
  const ElementKind kind = config_.microtubules.element == "p2" ? ElementKind::kP2 : ElementKind::kP1;
  struts_ = std::make_shared<LayeredBody<3>>(
      straight(all), kind, LayeredBody<3>::Materials{std::shared_ptr(makeMaterial(material))}, Inversion::kAllowed);
  const std::vector<Eigen::Vector3d>& nodes = struts_->mesh().nodes;
  node_positions_->assign(nodes.begin(), nodes.begin() + struts_->nodeCount());
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(3 * struts_->nodeCount());
  const auto shorten = [&](int node, int vertex) {
    const Eigen::Vector3d& n = along[vertex];
    displacement.segment<3>(3 * node) = -strain * n.dot(nodes[node] - middle[vertex]) * n;
  };
  for (const auto& element : struts_->mesh().elements) {
    for (const int node : element) {
      if (node < struts_->nodeCount()) shorten(node, element[0]);
    }
  }
  return displacement;
}

void TensegrityStructure::makeMembrane() {
  const std::vector<Eigen::Vector3d> corners(geometry_.ends.begin(), geometry_.ends.end());
  GeodesicSphere sphere(corners, geometry_.triangles, config_.membrane.divisions);
  for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
    if (i < corners.size()) {
      membrane_.nodes.push_back(ends_[i]);
    } else {
      membrane_.nodes.push_back(static_cast<int>(node_positions_->size()));
      node_positions_->push_back(sphere.vertices[i]);
    }
  }
  membrane_.rest = std::move(sphere.vertices);
  membrane_.triangles = std::move(sphere.triangles);
  membrane_.radius = config_.radius;
}

/// `tightness`: share of the prestress.
TensegrityStructure::Parts TensegrityStructure::makeParts(const Eigen::VectorXd& start, double tightness) const {
  std::vector<Cables::Cable> cables;
  for (std::size_t i = 0; i < geometry_.cables.size(); ++i) {
    if (std::count(config_.cut.begin(), config_.cut.end(), static_cast<int>(i)) > 0) continue;
    const TensegrityGeometry::Cable& cable = geometry_.cables[i];
    const CableConfig& kind = cable.kind == TensegrityGeometry::Kind::kActin ? config_.actin : config_.intermediate;
    const double rest_length = tightness == 1 ? cable.rest_length : cable.length / (1 + tightness * kind.prestrain);
    cables.push_back(
        {ends_[cable.a], ends_[cable.b], rest_length, kind.filaments.axialStiffness(), kind.retardation_time});
  }
  const FilamentConfig& filaments = config_.microtubules.filaments;
  const double across = StrutMesh::circumradius(filaments.section());
  const double spin = kSpin * filaments.bendingStiffness() / (geometry_.strut_length * across * across);
  std::vector<std::array<int, 2>> pairs;
  for (const std::vector<int>& middle : middles_) pairs.push_back({middle[0], middle[2]});
  Parts parts;
  parts.cables = std::make_shared<Cables>(node_positions_, std::move(cables), start);
  parts.terms = {struts_, parts.cables, std::make_shared<Membrane>(node_positions_, membrane_, config_.membrane, start),
                 std::make_shared<SpinStop>(pairs, spin, initial_)};
  return parts;
}

std::vector<int> TensegrityStructure::heldNodes() const {
  std::vector<int> nodes;
  for (const int end : geometry_.held) nodes.push_back(ends_[end]);
  return nodes;
}

std::vector<int> TensegrityStructure::middleNodes(int strut) const { return middles_[strut]; }

std::vector<Eigen::Vector3d> TensegrityStructure::strutLine(int strut, const Eigen::VectorXd& state) const {
  const auto& [a, b] = geometry_.struts[strut];
  std::vector<Eigen::Vector3d> line = {position(ends_[a], state)};
  for (const int first : sections_[strut]) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int corner = 0; corner < StrutMesh::kCorners; ++corner) middle += position(first + corner, state);
    line.push_back(middle / StrutMesh::kCorners);
  }
  line.push_back(position(ends_[b], state));
  return line;
}

double TensegrityStructure::strutForce(int strut, const Eigen::VectorXd& state) const {
  const auto& [a, b] = geometry_.struts[strut];
  const Eigen::Vector3d axis = (position(ends_[b], state) - position(ends_[a], state)).normalized();
  const Eigen::Vector3d unloaded = (*node_positions_)[ends_[b]] - (*node_positions_)[ends_[a]];
  const Material& material = *struts_->materials().front();
  const int elements = struts_->elementCount() / 6;
  double sum = 0;
  for (int e = strut * elements; e < (strut + 1) * elements; ++e) {
    for (int q = 0; q < struts_->pointCount(); ++q) {
      const Eigen::Matrix3d stress = material.stress(struts_->deformationGradient(e, q, state));
      sum += struts_->weight(e, q) * axis.dot(stress * unloaded.normalized());
    }
  }
  return sum / unloaded.norm();
}

bool TensegrityStructure::isActin(int cable) const {
  int number = -1;  // in the geometry
  for (int left = cable; left >= 0; --left) {
    do {
      ++number;
    } while (std::count(config_.cut.begin(), config_.cut.end(), number) > 0);
  }
  return geometry_.cables[number].kind == TensegrityGeometry::Kind::kActin;
}

Constraints TensegrityStructure::constraints(const std::vector<int>& following) const {
  Constraints result;
  result.entries.assign(start_.size(), Constraints::kFree);
  for (int k = 0; k < 3; ++k) {
    for (const int node : heldNodes()) result.entries[3 * node + k] = Constraints::kFixed;
    for (const int node : following) {
      int& entry = result.entries[3 * node + k];
      if (entry == Constraints::kFixed) throw std::invalid_argument("the tip's patch has a held strut end");
      entry = Constraints::tip(k);
    }
    result.entries[result.entries.size() - 3 + k] = Constraints::tip(k);
  }
  return result;
}

void TensegrityStructure::makeSurface() {
  TetMesh fan;  // its boundary is the membrane, with neighbours
  for (std::size_t node = 0; node < node_positions_->size(); ++node) {
    fan.vertices.push_back(position(static_cast<int>(node), start_));
  }
  const int centre = static_cast<int>(fan.vertices.size());
  fan.vertices.emplace_back(Eigen::Vector3d::Zero());
  for (const std::array<int, 3>& triangle : membrane_.triangles) {
    std::array<int, 4> corners = {centre, 0, 0, 0};
    for (int a = 0; a < 3; ++a) corners[a + 1] = membrane_.nodes[triangle[a]];
    fan.tetrahedra.push_back(corners);
  }
  surface_ = extractSurface(fan);
}

/// Relaxes the caps and the bow of each strut alone, with all strut ends held.
void TensegrityStructure::settleStruts() {
  Parts parts = makeParts(start_, 1);
  Constraints held = constraints({});
  for (const int node : ends_) {
    for (int k = 0; k < 3; ++k) held.entries[3 * node + k] = Constraints::kFixed;
  }
  EquilibriumSystem system(parts.terms, held, SymmetricSolver::Method::kSimplicial);
  RelaxationConfig config;
  config.length = 2 * config_.radius;
  config.maximum_iterations = kFactorisations;  // an approximation suffices: the last digits may take very long
  form_.iterations += Relaxation(system, config).relax(start_).iterations;
}

void TensegrityStructure::findForm() {
  settleStruts();
  double done = 0, step = 1;
  while (done < 1) {
    Eigen::VectorXd state = start_;
    const double next = std::min(1.0, done + step);
    if (balance(state, next)) {
      start_.swap(state);
      done = next;
      step *= 2;
      continue;
    }
    step /= 2;
    if (step >= kSmallestPrestressStep) continue;
    char text[120];
    std::snprintf(text, sizeof(text), "the tensegrity cell has no stable equilibrium beyond %.3g of its prestress",
                  done);
    throw std::runtime_error(text);
  }
}

/// Full steps of Newton's method, also when a step makes the residual larger (cables that alternate
/// between slack and taut), as long as one of the last steps improved it. False when the final
/// state is not stable.
bool TensegrityStructure::refine(EquilibriumSystem& system, Eigen::VectorXd& state) {
  Eigen::VectorXd at = state, residual;
  Eigen::Vector3d reaction;
  form_.residual = std::numeric_limits<double>::infinity();
  bool stable = false;
  for (int i = 0, worse = 0; worse < kMostWorseSteps; ++i, ++form_.iterations) {
    if (!system.residual(at, residual, reaction)) break;
    const double size = residual.lpNorm<Eigen::Infinity>();
    const bool better = size < form_.residual;
    if (!system.factorise(at)) break;
    worse = better ? 0 : worse + 1;
    if (better) {
      stable = true;
      state = at;
      form_.residual = size;
    }
    system.addTo(at, -system.solve(residual), Eigen::Vector3d::Zero());
  }
  return stable;
}

/// Relaxation approaches the equilibrium from any state (bent struts, a cut cable). Newton's method
/// then converges to rounding.
bool TensegrityStructure::balance(Eigen::VectorXd& state, double tightness) {
  Parts parts = makeParts(state, tightness);
  EquilibriumSystem system(parts.terms, constraints({}), SymmetricSolver::Method::kSimplicial);
  RelaxationConfig relaxation;
  relaxation.length = 2 * config_.radius;
  relaxation.maximum_iterations = kFactorisations;
  form_.iterations += Relaxation(system, relaxation).relax(state).iterations;
  const bool stable = refine(system, state);
  form_.prestress = 0;
  for (int i = 0; i < parts.cables->elementCount(); ++i) {
    form_.prestress = std::max(form_.prestress, parts.cables->tension(i, state));
  }
  system.energy(state, form_.energy);
  const FilamentConfig& filaments = config_.microtubules.filaments;
  const double face = geometry_.strut_length / config_.microtubules.slices * 2 * filaments.radius();
  const double rounding = kRounding * filaments.young_modulus * face;
  return stable && form_.residual <= std::max(kTolerance * form_.prestress, rounding);
}

}  // namespace microinjection
