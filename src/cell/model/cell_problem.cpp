#include "cell/model/cell_problem.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "cell/contact/pipette_mouth.h"
#include "cell/contact/rigid_contact.h"
#include "cell/contact/rounded_tip.h"
#include "cell/contact/suction_load.h"
#include "cell/mechanics/proximal_anchor.h"
#include "cell/mechanics/surface_tension.h"
#include "cell/mechanics/viscous_stress.h"

namespace microinjection {
namespace {

/// Contact stiffness, in units of the stiffest layer's modulus over the tip's radius. At a pressure
/// equal to that modulus the tip then enters the surface by a thousandth of its radius.
constexpr double kPenalty = 1000;
constexpr double kSlipRange = 0.01;  ///< elastic slip before sliding, in the size of the surface
constexpr double kDeepest = 0.03;    ///< largest allowed penetration, over the tip's radius or the lip's edge

/// Young's modulus, Pa, of the stiffest layer, unrelaxed.
double largestModulus(const Scene& scene) {
  double result = 0;
  for (const Scene::Layer& layer : scene.cell.layers) {
    double ratio = 1;
    for (const PronyTerm& term : layer.material.viscoelasticity.prony) ratio += term.modulus_ratio;
    result = std::max(result, ratio * layer.material.young_modulus);
  }
  return result;
}
constexpr double kWithinCircle = 1 + 1e-9;

/// Component of the path's translation that is the pressure of a held cell: the needle of a section, or in a plane of
/// symmetry, does not use it.
constexpr int kPressure = 1;
constexpr double kAnchor = 1e-2;  ///< stiffness of the anchor's springs, over modulus times radius
constexpr double kOverlap =
    5e-3;  ///< of lip and undeformed cell, over the lip's edge radius: so the lip has a stiffness

SymmetricSolver::Method method(ElementKind element, int dimension) {
  if (hasContinuousPressure(element)) return SymmetricSolver::Method::kIndefinite;
  return dimension == 3 ? SymmetricSolver::Method::kSupernodal : SymmetricSolver::Method::kSimplicial;
}

double distanceFromLine(const Eigen::Vector2d& rz, const Eigen::Vector2d& /*on the axis*/) { return rz[0]; }
double distanceFromLine(const Eigen::Vector3d& x, const Eigen::Vector2d& line) { return (x.head<2>() - line).norm(); }

/// Number of the mesh's nodes that the elements displace: all nodes, or the vertices.
template <int Dim>
int displacedNodes(const LayeredBody<Dim>& body) {
  return isQuadratic(body.kind()) ? static_cast<int>(body.mesh().nodes.size()) : body.mesh().vertex_count;
}

/// Nodes of the outer surface's facets that lie within `radius` of a vertical line on one side.
template <int Dim>
std::vector<int> nodesWithin(const LayeredBody<Dim>& body, const Eigen::Vector2d& line, double radius, double side) {
  const QuadraticMesh<Dim>& mesh = body.mesh();
  std::vector<char> inside(mesh.nodes.size(), 0);
  for (const auto& facet : mesh.facets) {
    bool all = facet.layer == 0;
    for (int corner = 0; corner < Dim; ++corner) {
      const auto& x = mesh.nodes[facet.nodes[corner]];
      all = all && side * x[Dim - 1] > 0 && distanceFromLine(x, line) <= kWithinCircle * radius;
    }
    for (int node : facet.nodes) inside[node] |= all;
  }
  std::vector<int> nodes;
  for (int node = 0; node < displacedNodes(body); ++node) {
    if (inside[node]) nodes.push_back(node);
  }
  return nodes;
}

/// (r, z) of a section's deformed outer surface, m, from the lower pole to the upper one.
Eigen::Matrix2Xd outlineOf(const LayeredBody<2>& body, const Eigen::VectorXd& state) {
  const QuadraticMesh<2>& mesh = body.mesh();
  const auto angle = [&](int node) { return std::atan2(mesh.nodes[node][0], -mesh.nodes[node][1]); };
  const auto before = [&](int a, int b) { return angle(a) < angle(b); };
  std::set<int, decltype(before)> nodes(before);
  for (const auto& facet : mesh.facets) {
    if (facet.layer == 0) nodes.insert(facet.nodes.begin(), facet.nodes.end());
  }
  Eigen::Matrix2Xd outline(2, static_cast<Eigen::Index>(nodes.size()));
  Eigen::Index column = 0;
  for (const int node : nodes) outline.col(column++) = mesh.nodes[node] + state.segment<2>(2 * node);
  return outline;
}
Eigen::Matrix2Xd outlineOf(const LayeredBody<3>&, const Eigen::VectorXd&) { return {}; }

/// Throws std::invalid_argument when the mesh is not the half y >= 0, whose forces are doubled.
template <int Dim>
void checkMirror(const Scene& scene, const QuadraticMesh<Dim>& mesh) {
  const auto beyond = [](const auto& x) { return x[1] < 0; };
  if (Dim != 3 || scene.needle.offset.y() != 0 || std::any_of(mesh.nodes.begin(), mesh.nodes.end(), beyond)) {
    throw std::invalid_argument("mirror symmetry needs the half y >= 0 of a mesh in space and the needle in y = 0");
  }
}

}  // namespace

template <int Dim>
CellProblem<Dim>::CellProblem(const Scene& scene, QuadraticMesh<Dim> mesh, ElementKind element, Symmetry symmetry)
    : symmetry_(symmetry),
      body_(std::make_shared<LayeredBody<Dim>>(std::move(mesh), element, scene.cell.makeMaterials())) {
  if (symmetry == Symmetry::kMirror) checkMirror(scene, body_->mesh());
  EquilibriumSystem::Terms terms = {body_};
  bool linear = body_->isLinear() && !scene.needle.tip.rounded();
  for (std::size_t i = 0; i < scene.cell.layers.size(); ++i) {
    const Scene::Layer& layer = scene.cell.layers[i];
    if (layer.surface_tension == 0) continue;
    linear = false;
    terms.push_back(
        std::make_shared<SurfaceTension<Dim>>(*body_, static_cast<int>(i), layer.outer_radius, layer.surface_tension));
  }
  std::vector<ViscoelasticityConfig> viscoelasticity;
  for (const Scene::Layer& layer : scene.cell.layers) viscoelasticity.push_back(layer.material.viscoelasticity);
  if (!std::all_of(viscoelasticity.begin(), viscoelasticity.end(), [](const auto& layer) { return layer.empty(); })) {
    linear = false;
    terms.push_back(std::make_shared<ViscousStress<Dim>>(body_, viscoelasticity));
  }
  if (scene.needle.tip.rounded()) addContact(scene, terms);
  if (scene.holding_pipette.mouth) addSuction(scene, terms);
  system_ = std::make_unique<EquilibriumSystem>(terms, constraints(scene), method(element, Dim));
  path_ = std::make_unique<LoadPath>(*system_, pathConfig(scene, linear));
}

template <int Dim>
CellProblem<Dim>::CellProblem(std::shared_ptr<LayeredBody<Dim>> body, const Constraints& constraints,
                              const LoadPathConfig& path_config, SymmetricSolver::Method method)
    : body_(std::move(body)),
      system_(std::make_unique<EquilibriumSystem>(EquilibriumSystem::Terms{body_}, constraints, method)),
      path_(std::make_unique<LoadPath>(*system_, path_config)) {}

template <int Dim>
Constraints CellProblem<Dim>::constraints(const Scene& scene) const {
  Constraints result;
  result.entries.assign(body_->stateSize(), Constraints::kFree);
  if (hasContinuousPressure(body_->kind())) {
    result.pressures = body_->pressureCount();
  } else {
    std::fill_n(result.entries.end() - 3 - body_->pressureCount(), body_->pressureCount(), Constraints::kInternal);
  }
  for (int k = 0; k < 3; ++k) {  // a section's needle moves along the axis only
    result.entries[body_->tipEntry() + k] = Dim == 2 && k != 2 ? Constraints::kFixed : Constraints::tip(k);
  }
  const bool mirror = symmetry_ == Symmetry::kMirror;
  if (mirror) result.entries[body_->tipEntry() + 1] = Constraints::kFixed;
  if (scene.holding_pipette.mouth) result.entries[body_->tipEntry() + kPressure] = Constraints::tip(kPressure);
  for (int node = 0; mirror && node < displacedNodes(*body_); ++node) {
    if (body_->mesh().nodes[node][1] == 0) result.entries[Dim * node + 1] = Constraints::kFixed;
  }
  for (int node = 0; Dim == 2 && node < displacedNodes(*body_); ++node) {
    if (body_->mesh().nodes[node][0] == 0) result.entries[Dim * node] = Constraints::kFixed;
  }
  if (scene.holding_pipette.mouth) return result;
  std::vector<char> held(body_->nodeCount(), 0);
  for (int node : nodesWithin(*body_, Eigen::Vector2d::Zero(), scene.holding_pipette.contact_radius, -1)) {
    held[node] = 1;
    for (int k = 0; k < Dim; ++k) result.entries[Dim * node + k] = Constraints::kFixed;
  }
  if (scene.needle.tip.rounded()) return result;
  for (int node : nodesWithin(*body_, scene.needle.offset, scene.needle.tip.radius, +1)) {
    if (held[node]) throw std::invalid_argument("the tip's patch and the held vertices overlap");
    for (int k = 0; k < Dim; ++k) result.entries[Dim * node + k] = Constraints::tip(k);
    if (mirror) result.entries[Dim * node + 1] = Constraints::kFixed;
    if (Dim == 2) {  // along the axis only
      result.entries[Dim * node] = Constraints::kFixed;
      result.entries[Dim * node + 1] = Constraints::tip(2);
    }
  }
  return result;
}

/// @returns what all contacts of a scene have in common, with the penalty of a surface of this size (m)
RigidContactConfig contactConfig(const Scene& scene, const Scene::Contact& contact, double size) {
  RigidContactConfig config;
  config.mode = contact.mode == "sliding" ? RigidContactConfig::Mode::kSliding : RigidContactConfig::Mode::kSticking;
  config.friction = contact.friction;
  config.slip_range = kSlipRange * size;
  config.adhesion = contact.adhesion_energy;
  config.adhesion_range = contact.adhesion_range;
  config.penalty = kPenalty * largestModulus(scene) / size;
  return config;
}

template <int Dim>
void CellProblem<Dim>::addContact(const Scene& scene, EquilibriumSystem::Terms& terms) {
  const Scene::Needle& needle = scene.needle;
  const RoundedTip tip = RoundedTip::make(needle.tip.shape, needle.tip.radius, needle.tip.edge_radius);
  RigidContactConfig config = contactConfig(scene, needle.contact, needle.tip.radius);
  config.moves[kPressure] = !scene.holding_pipette.mouth;
  config.origin << needle.offset, tip.touchHeight(scene.radius(), needle.offset);
  contact_ = std::make_shared<RigidContact<Dim>>(*body_, std::make_shared<RoundedTip>(tip), config);
  deepest_ = kDeepest * needle.tip.radius;
  terms.push_back(contact_);
}

template <int Dim>
void CellProblem<Dim>::addSuction(const Scene& scene, EquilibriumSystem::Terms& terms) {
  if (Dim == 3 && symmetry_ != Symmetry::kMirror)
    throw ConfigError("holding_pipette/mouth: a cell that suction holds is solved with the needle in y = 0 only");
  const Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  const auto lip = std::make_shared<PipetteMouth>(mouth.inner_radius, mouth.outer_radius, mouth.edge_radius, -1);
  RigidContactConfig config = contactConfig(scene, mouth.contact, mouth.edge_radius);
  config.moves = {false, false, false};
  config.origin.z() = kOverlap * mouth.edge_radius - lip->touchDistance(scene.radius());
  lip_ = std::make_shared<RigidContact<Dim>>(*body_, lip, config);
  const double modulus = largestModulus(scene), radius = scene.radius();
  suction_ = std::make_shared<SuctionLoad<Dim>>(*body_, *lip, radius, config.origin.z(), lip_,
                                                body_->tipEntry() + kPressure, modulus / radius);
  const int nodes = displacedNodes(*body_);
  std::vector<std::vector<int>> entries(nodes);
  for (int node = 0; node < nodes; ++node) {
    for (int k = 0; k < Dim; ++k) entries[node].push_back(Dim * node + k);
  }
  anchor_ =
      std::make_shared<ProximalAnchor>(entries, std::vector<double>(nodes, 1.0 / nodes), kAnchor * modulus * radius);
  terms.insert(terms.end(), {lip_, suction_, anchor_});
  holding_pressure_ = mouth.pressure;
  on_axis_ = scene.needle.offset.isZero(0);
  away_ = radius / 4;
  deepest_into_lip_ = kDeepest * mouth.edge_radius;
}

template <int Dim>
LoadPath::Result CellProblem<Dim>::hold(double pressure) {
  touch_.reset();
  holding_pressure_ = pressure;
  LoadPath::Result result = path_->advance({0, path_->translation()[kPressure], away_});
  if (result.converged) result = path_->advance({0, pressure / suction_->unit(), away_});
  if (!result.converged) return result;
  if (lip_->penetration() > deepest_into_lip_) {
    result.converged = false;
    result.reason =
        "the lip enters the surface by more than 3 % of its edge's radius: the contact is too soft for this cell";
    return result;
  }
  touch_ = touchHeight();
  return result;
}

/// m, the needle's translation along z at which it touches the cell of the present state, from its line now. On the
/// axis it meets the pole, about which the surface hardly changes its shape; the mesh's points beside it would be too
/// low.
template <int Dim>
double CellProblem<Dim>::touchHeight() const {
  const auto& nodes = body_->mesh().nodes;
  if (on_axis_) {
    const auto lower = [](const auto& a, const auto& b) { return a[Dim - 1] < b[Dim - 1]; };
    const auto pole = std::max_element(nodes.begin(), nodes.begin() + displacedNodes(*body_), lower) - nodes.begin();
    return path_->state()[Dim * pole + Dim - 1];
  }
  double low = -away_, high = away_;
  while (high - low > 1e-9 * away_) {
    const double middle = (low + high) / 2;
    (contact_->clearance(path_->state(), {0, 0, middle}) > 0 ? high : low) = middle;
  }
  return high;
}

template <int Dim>
HeldCell CellProblem<Dim>::held() const {
  const Eigen::VectorXd& state = path_->state();
  HeldCell held;
  held.pressure = path_->translation()[kPressure] * suction_->unit();
  held.tongue_length = suction_->apex(state);
  const double whole = symmetry_ == Symmetry::kMirror ? 2 : 1;  // of the cell, half of which is solved
  held.tongue_volume = whole * suction_->volume(state);
  held.seal_radius = suction_->sealRadius();
  held.clamping_force = whole * lip_->ring(state).force;
  held.imbalance = whole * anchor_->residualForce(state)[Dim - 1];
  held.outline = outlineOf(*body_, state);
  return held;
}

template <int Dim>
void CellProblem<Dim>::reset() {
  path_->reset();
  touch_.reset();
}

template <int Dim>
Eigen::Vector3d CellProblem<Dim>::tipDisplacement() const {
  Eigen::Vector3d translation = path_->translation();
  if (suction_) translation[kPressure] = 0;
  if (touch_) translation.z() -= *touch_;
  return translation;
}

template <int Dim>
LoadPathConfig CellProblem<Dim>::pathConfig(const Scene& scene, bool linear) {
  const double diameter = scene.cell.diameter(), tip = scene.needle.tip.radius;
  LoadPathConfig config;
  config.length = diameter;
  config.first_step = config.largest_step = diameter / 16;
  config.smallest_step = 1e-3 * tip;
  config.linear = linear;
  if (scene.needle.tip.rounded()) {  // points stick where they first touch, so the path needs small steps
    config.smooth = false;
    config.first_step = tip / (Dim == 2 ? 40 : 20);  // steps in space cost seconds
    config.largest_step = tip / (Dim == 2 ? 8 : 4);
    config.smallest_step = 1e-5 * tip;
    if (Dim == 3) config.easy = 10;  // new contact points need iterations in steps of any length
  }
  return config;
}

template <int Dim>
IndentationSolution CellProblem<Dim>::solve(const Eigen::Vector3d& tip_displacement, double duration) {
  if (symmetry_ == Symmetry::kMirror && tip_displacement.y() != 0) {
    throw std::invalid_argument("half a cell's tip must stay in the plane of symmetry, y = 0");
  }
  const double start = threadCpuTime();
  Eigen::Vector3d target = tip_displacement;
  LoadPath::Result result;
  bool ready = !suction_ || touch_;
  if (!ready) {  // the way to the cell takes no time
    result = hold(holding_pressure_);
    if (touch_) result = path_->advance({0, path_->translation()[kPressure], *touch_});
    ready = result.converged;
  }
  if (ready) {
    if (suction_) target += Eigen::Vector3d(0, path_->translation()[kPressure], *touch_);
    result = path_->advance(target, duration);
  }
  if (result.converged && holding_pressure_ < 0 && lip_->ring(path_->state()).radius == 0) {
    result.converged = false;
    result.reason = "the lip lets go of the cell";
  }
  IndentationSolution solution;
  solution.converged = result.converged;
  solution.reason = result.reason;
  if (solution.converged && contact_ && contact_->penetration() > deepest_) {
    solution.converged = false;
    solution.reason =
        "the tip enters the surface by more than 3 % of its radius: the contact is too soft for this cell";
  }
  solution.tip_displacement = tipDisplacement();
  solution.force = -path_->reaction();
  solution.stiffness = path_->stiffness();
  if (suction_) {  // what belongs to the pressure is no force
    solution.force[kPressure] = 0;
    solution.stiffness.row(kPressure).setZero();
    solution.stiffness.col(kPressure).setZero();
  }
  if (symmetry_ == Symmetry::kMirror) {  // the other half
    solution.force *= 2;
    solution.stiffness *= 2;
  }
  solution.smallest_jacobian = body_->smallestJacobian(path_->state());
  solution.newton_iterations = result.newton_iterations;
  solution.cpu_time = threadCpuTime() - start;
  return solution;
}

template class CellProblem<2>;
template class CellProblem<3>;

}  // namespace microinjection
