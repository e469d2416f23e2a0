// What suction bears of a soft cell: the cell solved with its lip, suction and friction, in space, against HoldLimits.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "cell/contact/pipette_mouth.h"
#include "cell/contact/rigid_contact.h"
#include "cell/contact/suction_load.h"
#include "cell/mechanics/load_path.h"
#include "cell/mechanics/proximal_anchor.h"
#include "cell/mechanics/reference_element.h"
#include "cell/mesh/swept_mesh.h"
#include "cell/model/scene.h"
#include "cell/model/scene_mesh.h"
#include "cell/pose/cell_motion.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kDrive = 0, kPressure = 1, kStill = 2;  // entries of the path's translation
constexpr double kModulus = 5e3;                      // Pa
constexpr double kPenalty = 1000;  // of the lip, in moduli over its edge's radius, as CellProblem has it
constexpr double kOverlap = 5e-3;  // of lip and undeformed cell, over that radius
constexpr double kAnchor = 1e-2;   // over modulus times radius
constexpr double kStep = 0.02;     // of the drive, over the cell's radius
constexpr double kGrip = 0.25;     // reach of the springs, over the cell's radius
constexpr double kInside = 0.85;   // their middle below the loaded point, over its distance from the centre
constexpr double kPlateau = 0.03;  // growth of the force, over the drive's, at which the cell slides
constexpr double kGrowing = 20;    // steps of the drive over which friction grows
constexpr int kMostSteps = 80;

struct HeldScene {
  const char* name;
  double radius, inner, outer, edge;  // m
  double suction;                     // over the modulus

  PipetteMouth mouth(double side) const { return PipetteMouth(inner, outer, edge, side); }
  CellMotionConfig motion(double friction) const {
    CellMotionConfig config;
    config.radius = radius;
    config.modulus = kModulus;
    config.friction.lip = friction;
    return config;
  }
  HoldLimits rigid(double friction) const {
    const double seal = mouth(1).touchRadius(radius);
    return HoldLimits(suction * kModulus * M_PI * seal * seal, seal, radius, friction);
  }
  HoldLimits soft(double friction) const {
    return CellMotion(motion(friction), mouth(1), {}).limits(-suction * kModulus);
  }
};

/// In a frame at the undeformed cell's centre whose z points out of the pipette.
struct HeldLoad {
  const char* name;
  Vector3d point;  // m
  Vector3d direction;
  double friction;  // of the lip

  double largest(const HoldLimits& limits, const Vector3d& at) const {  // whose frame's z points into the pipette
    const Vector3d mirrored(1, 1, -1);
    return limits.largest(at.cwiseProduct(mirrored), direction.cwiseProduct(mirrored));
  }
};

Scene sceneOf(const HeldScene& held, double friction) {
  Scene scene;
  scene.cell.layers[0].outer_radius = held.radius;
  scene.cell.material().model = "neo_hookean";
  scene.cell.material().young_modulus = kModulus;
  scene.cell.material().poisson_ratio = 0.49;
  scene.needle.tip = {"hemisphere", 0.4 * held.radius, 0};  // only the mesh knows it: coarse where a needle would be
  scene.holding_pipette.mouth =
      Scene::Mouth{held.inner, held.outer, held.edge, -held.suction * kModulus, {"sliding", friction, 0, 0}};
  scene.holding_pipette.contact_radius = held.inner + held.edge;
  scene.validate();
  return scene;
}

template <int Dim>
QuadraticMesh<Dim> heldMesh(const Scene& scene, double level, int segments) {
  QuadraticMesh<2> section = makeSceneMesh<2>(scene, level);
  if constexpr (Dim == 2) {
    return section;
  } else {
    SweepConfig sweep;
    sweep.half = true;
    sweep.segments = segments;
    sweep.holding_radius = scene.holding_pipette.contact_radius;
    return sweepSection(section, sweep);
  }
}

Eigen::Vector2d inSection(const Vector3d& v) { return {v.x(), v.z()}; }
template <int Dim>
Eigen::Matrix<double, Dim, 1> ofMesh(const Vector3d& v) {
  if constexpr (Dim == 2) {
    return inSection(v);
  } else {
    return v;
  }
}

/// Soft springs between the nodes about a point and an entry of the path's translation (m) along a direction. A patch
/// that followed it rigidly could not turn with the cell.
template <int Dim>
class Harness : public EnergyTerm {
 public:
  using Vector = Eigen::Matrix<double, Dim, 1>;

  Harness(const LayeredBody<Dim>& body, const Vector& point, double reach, const Vector& direction, double stiffness,
          int entry)
      : drive_(body.tipEntry() + entry) {
    by_ << direction, -1;
    double sum = 0;
    for (int node = 0; node < static_cast<int>(body.mesh().nodes.size()); ++node) {
      const Vector& at = body.mesh().nodes[node];
      // In the plane half of a node belongs to the other half of the cell; in a section a node is a circle.
      const double weight = Dim == 2 ? at[0] / reach : at[1] == 0 ? 0.5 : 1;
      if ((at - point).norm() > reach || !(weight > 0)) continue;
      undeformed_.push_back(at);
      entries_.emplace_back();
      for (int k = 0; k < Dim; ++k) entries_.back().push_back(Dim * node + k);
      entries_.back().push_back(drive_);
      stiffness_.push_back(weight);
      sum += weight;
    }
    for (double& each : stiffness_) each *= stiffness / sum;
  }

  int elementCount() const override { return static_cast<int>(entries_.size()); }
  const std::vector<int>& entries(int node) const override { return entries_[node]; }
  bool evaluate(int node, const VectorXd& state, Order order, LocalEnergy& result) const override {
    const double k = stiffness_[node], stretch = by_.dot(VectorXd(state(entries_[node])));
    result.zero = false;
    result.energy = 0.5 * k * stretch * stretch;
    if (order != Order::kEnergy) result.gradient = k * stretch * by_;
    if (order == Order::kHessian) result.hessian = k * by_ * by_.transpose();
    return true;
  }

  /// m: where one force would act in place of all.
  Vector centre(const VectorXd& state) const {
    Vector sum = Vector::Zero();
    double force = 0;
    for (int node = 0; node < elementCount(); ++node) {
      const VectorXd at = state(entries_[node]);
      const double each = stiffness_[node] * by_.dot(at);
      sum += each * (undeformed_[node] + at.head<Dim>());
      force += each;
    }
    return sum / force;
  }

 private:
  Eigen::Matrix<double, Dim + 1, 1> by_;
  int drive_;
  std::vector<std::vector<int>> entries_;
  std::vector<Vector> undeformed_;
  std::vector<double> stiffness_;  // N/m
};

/// Coulomb's friction of a cell that turns about the y axis in its seat: everywhere against the material's way, whose
/// direction F (w x X) is known, as the form stays while the material turns through it. So no point sticks, and no node
/// passes the lip. The tractions of a step are those of the contact at the first equilibrium that it finds.
class SlidingSeat : public EnergyTerm {
 public:
  /// @param origin m, of the mouth's frame. @param penalty Pa/m, of the lip. @param growing m, way of the drive over
  /// which friction grows to its coefficient
  SlidingSeat(const LayeredBody<3>& body, std::shared_ptr<const PipetteMouth> mouth, const Vector3d& origin,
              double penalty, double friction, double growing)
      : body_(body),
        mouth_(std::move(mouth)),
        origin_(origin),
        penalty_(penalty),
        friction_(friction),
        growing_(growing) {
    const double reach = 2 * mouth_->edgeRadius();
    for (const QuadraticMesh<3>::Facet& facet : body.mesh().facets) {
      const bool near = std::any_of(facet.nodes.begin(), facet.nodes.end(), [&](int node) {
        return mouth_->distance(body.mesh().nodes[node] - origin_) < reach;
      });
      if (!near) continue;
      facets_.push_back(facet);
      entries_.emplace_back();
      for (const int node : facet.nodes) {
        for (int k = 0; k < 3; ++k) entries_.back().push_back(3 * node + k);
      }
    }
    reset();
  }

  int elementCount() const override { return static_cast<int>(entries_.size()); }
  const std::vector<int>& entries(int facet) const override { return entries_[facet]; }
  /// N m, about the y axis, that friction bears at the last equilibrium, by its power as the material turns.
  double moment() const { return moment_; }
  bool evaluate(int facet, const VectorXd& state, Order order, LocalEnergy& result) const override {
    const VectorXd& force = forces_[facet];
    result.zero = force.isZero(0);
    result.energy = -force.dot(VectorXd(state(entries_[facet])));
    if (order != Order::kEnergy) result.gradient = -force;
    if (order == Order::kHessian) result.hessian = Eigen::MatrixXd::Zero(force.size(), force.size());
    return true;
  }
  bool beginStep(double /*duration*/) override {
    forces_ = accepted_;
    return false;
  }
  bool settle(const VectorXd& state) override {
    double change = 0, sum = 0, moment = 0;
    for (int facet = 0; facet < elementCount(); ++facet) {
      const VectorXd now = forceOf(facet, state, moment);
      change += (now - forces_[facet]).squaredNorm();
      sum += now.squaredNorm();
      forces_[facet] = now;
    }
    return change > kSettled * kSettled * sum;
  }
  void accept(const VectorXd& state) override {
    accepted_ = forces_;
    moment_ = 0;
    for (int facet = 0; facet < elementCount(); ++facet) forceOf(facet, state, moment_);
  }
  void reset() override {
    forces_.clear();
    for (const std::vector<int>& each : entries_) forces_.emplace_back(VectorXd::Zero(each.size()));
    accepted_ = forces_;
  }

 private:
  static constexpr double kSettled = 1e-3;  // change of the tractions, over themselves
  static constexpr int kNodes = QuadraticMesh<3>::kFacetNodes;

  /// @param moment N m, to which that of the facet's friction is added
  VectorXd forceOf(int facet, const VectorXd& state, double& moment) const {
    VectorXd result = VectorXd::Zero(3 * kNodes);
    for (const ReferenceElement::Point& at : referenceFacet<3>().points) {
      Vector3d undeformed = Vector3d::Zero(), deformed = Vector3d::Zero();
      Eigen::Matrix<double, 3, 2> before = Eigen::Matrix<double, 3, 2>::Zero(), now = before;  // tangents
      for (int a = 0; a < kNodes; ++a) {
        const Vector3d& x = body_.mesh().nodes[facets_[facet].nodes[a]];
        const Vector3d u = state.segment<3>(entries_[facet][3 * a]);
        undeformed += at.shape[a] * x;
        deformed += at.shape[a] * (x + u);
        before += x * at.gradient.row(a);
        now += (x + u) * at.gradient.row(a);
      }
      const Gap gap = mouth_->gap(deformed - origin_);
      if (gap.distance >= 0) continue;
      const Vector3d turn = Vector3d::UnitY().cross(undeformed);
      Vector3d way = now * (before.transpose() * before).ldlt().solve(before.transpose() * turn);
      way -= way.dot(gap.normal) * gap.normal;
      const double friction = friction_ * std::min(1.0, state[body_.tipEntry() + kDrive] / growing_);
      const Vector3d traction = friction * penalty_ * gap.distance * way.normalized();  // distance < 0: against it
      const double area = at.weight * before.col(0).cross(before.col(1)).norm();
      for (int a = 0; a < kNodes; ++a) result.segment<3>(3 * a) += at.shape[a] * area * traction;
      moment -= area * traction.dot(way);
    }
    return result;
  }

  const LayeredBody<3>& body_;
  std::shared_ptr<const PipetteMouth> mouth_;
  Vector3d origin_;
  double penalty_, friction_, growing_, moment_ = 0;
  std::vector<QuadraticMesh<3>::Facet> facets_;
  std::vector<std::vector<int>> entries_;
  std::vector<VectorXd> forces_, accepted_;  // N, on each facet's nodes
};

/// Mean of sqrt(a^2 cos^2 + b^2 sin^2) over a circle.
double meanLength(double a, double b) {
  constexpr int kPoints = 64;  // exact to rounding: the integrand is periodic
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double phi = 2 * M_PI * i / kPoints;
    sum += std::hypot(a * std::cos(phi), b * std::sin(phi));
  }
  return sum / kPoints;
}

/// A held cell that a drive loads more and more by soft springs, so that the load follows the cell when it gives way.
///
/// Friction of the lip is that of its contact, which sticks and slides. Or the cell turns in its seat all the time
/// (SlidingSeat), while further springs at the pole, across the tube, hold it. It begins to turn where the load's
/// moment about its centroid is that of friction: lip and suction have none, since the form's energy does not change.
/// The springs bear the moment that is missing until then, and what elements catch on the lip.
template <int Dim>
class LoadedCell {
 public:
  enum class Friction { kOfContact, kTurning };

  LoadedCell(const HeldScene& held, const HeldLoad& load, double level, int segments,
             Friction friction = Friction::kOfContact)
      : radius_(held.radius), stiffness_(2 * load.largest(held.rigid(load.friction), load.point) / held.radius) {
    const Scene scene = sceneOf(held, load.friction);
    body_ = std::make_shared<LayeredBody<Dim>>(heldMesh<Dim>(scene, level, segments), ElementKind::kP2P0,
                                               scene.cell.makeMaterials());
    const auto mouth = std::make_shared<PipetteMouth>(held.mouth(-1));
    RigidContactConfig config;
    config.mode = RigidContactConfig::Mode::kSliding;
    config.friction = friction == Friction::kOfContact ? load.friction : 0;
    config.penalty = kPenalty * kModulus / held.edge;
    config.moves = {false, false, false};
    config.origin.z() = kOverlap * held.edge - mouth->touchDistance(radius_);
    lip_ = std::make_shared<RigidContact<Dim>>(*body_, mouth, config);
    suction_ = std::make_shared<SuctionLoad<Dim>>(*body_, *mouth, radius_, config.origin.z(), lip_,
                                                  body_->tipEntry() + kPressure, kModulus / radius_);
    harness_ = std::make_shared<Harness<Dim>>(*body_, ofMesh<Dim>(kInside * load.point), kGrip * radius_,
                                              ofMesh<Dim>(load.direction), stiffness_ / kWhole, kDrive);
    const int nodes = static_cast<int>(body_->mesh().nodes.size());
    std::vector<std::vector<int>> entries(nodes);
    for (int i = 0; i < Dim * nodes; ++i) entries[i / Dim].push_back(i);
    const auto anchor = std::make_shared<ProximalAnchor>(entries, std::vector<double>(nodes, 1.0 / nodes),
                                                         kAnchor * kModulus * radius_);
    EquilibriumSystem::Terms terms{body_, lip_, suction_, harness_, anchor};
    if constexpr (Dim == 3) {
      if (friction == Friction::kTurning) {
        seat_ = std::make_shared<SlidingSeat>(*body_, mouth, config.origin, config.penalty, load.friction,
                                              kGrowing * kStep * radius_);
        terms.push_back(seat_);
        terms.push_back(std::make_shared<Harness<3>>(*body_, Vector3d(0, 0, kInside * radius_), kGrip * radius_,
                                                     Vector3d::UnitX(), kStiller * stiffness_ / kWhole, kStill));
      }
    }
    system_ = std::make_unique<EquilibriumSystem>(
        terms, constraints(), Dim == 3 ? SymmetricSolver::Method::kSupernodal : SymmetricSolver::Method::kSimplicial);
    LoadPathConfig path;
    path.length = 2 * radius_;
    path.first_step = path.largest_step = kStep * radius_;
    path.smallest_step = 1e-5 * radius_;
    path.smooth = false;
    path.easy = 10;
    path_ = std::make_unique<LoadPath>(*system_, path);
    result_ = path_->advance({0, scene.holding_pipette.mouth->pressure / suction_->unit(), 0});
  }

  bool inEquilibrium() const { return result_.converged; }
  const std::string& reason() const { return result_.reason; }
  double sealRadius() const { return suction_->sealRadius(); }
  double force() const { return kWhole * path_->reaction()[kDrive]; }
  int unknowns() const { return system_->freeSize(); }
  Eigen::Matrix<double, Dim, 1> loaded() const { return harness_->centre(path_->state()); }
  /// N, that a step of the drive adds where the cell does not yield.
  double forceOfStep() const { return stiffness_ * kStep * radius_; }

  /// N m, of the load about the cell's centre less that of friction: the cell turns where it is above 0.
  double turningMoment() const { return seat_ ? force() * (loaded()[0] - middle()) - kWhole * seat_->moment() : NAN; }
  /// N, that the further springs bear.
  double stillForce() const { return kWhole * -path_->reaction()[kStill]; }

  void drive() {
    Vector3d target = path_->translation();
    target[kDrive] += kStep * radius_;
    result_ = path_->advance(target);
  }

  /// N m, the moment about an axis across the tube at which friction lets the cell turn in its seat, by the lip's
  /// tractions without friction. A homogeneous sphere keeps its deformed form while its material turns through it by w,
  /// so nothing but friction resists. The material at the polar angle t slides by F (w x X), of length
  ///
  ///     w R sqrt(lambda_m^2 cos^2(phi) + lambda_h^2 cos^2(t) sin^2(phi))
  ///
  /// with the stretches lambda of meridian and circle; its mean over the azimuth phi times friction and push is the
  /// moment.
  double turning(double friction) const {
    static_assert(Dim == 2 || Dim == 3);
    double sum = 0;
    LocalEnergy local;
    for (int facet = 0; Dim == 2 && facet < lip_->elementCount(); ++facet) {
      if (!lip_->evaluate(facet, path_->state(), Order::kGradient, local) || local.zero) continue;
      const std::vector<int>& entries = lip_->entries(facet);  // of two corners and the node between them
      const auto undeformed = [&](int i) {
        return Eigen::Vector2d(body_->mesh().nodes[entries[2 * i] / 2].template head<2>());
      };
      const auto deformed = [&](int i) {
        return Eigen::Vector2d(undeformed(i) + path_->state().template segment<2>(entries[2 * i]));
      };
      const double meridian = (deformed(1) - deformed(0)).norm() / (undeformed(1) - undeformed(0)).norm();
      for (int i = 0; i < 3; ++i) {
        const double hoop = deformed(i).x() / undeformed(i).x(), cosine = undeformed(i).y() / undeformed(i).norm();
        sum += local.gradient.segment<2>(2 * i).norm() * meanLength(meridian, hoop * cosine);
      }
    }
    return friction * radius_ * sum;
  }

  /// Share of the lip's circle (of its facets, by their azimuth in parts of a meridian) that touches the cell.
  double pressedShare() const {
    std::vector<char> pressed(kParts, 0), there(kParts, 0);
    LocalEnergy local;
    for (int facet = 0; facet < lip_->elementCount(); ++facet) {
      if (!lip_->isNonsmooth(facet)) continue;
      const std::vector<int>& entries = lip_->entries(facet);
      Eigen::Matrix<double, Dim, 1> middle = Eigen::Matrix<double, Dim, 1>::Zero();
      for (std::size_t i = 0; i + Dim <= entries.size(); i += Dim) middle += body_->mesh().nodes[entries[i] / Dim];
      const double azimuth = Dim == 2 ? 0 : std::atan2(middle[1], middle[0]) / M_PI;
      const int part = std::clamp(static_cast<int>(kParts * azimuth), 0, kParts - 1);
      there[part] = 1;
      if (lip_->evaluate(facet, path_->state(), Order::kGradient, local) && !local.zero) pressed[part] = 1;
    }
    return std::count(pressed.begin(), pressed.end(), 1) /
           static_cast<double>(std::count(there.begin(), there.end(), 1));
  }

 private:
  static constexpr double kWhole = Dim == 3 ? 2 : 1;  // of the cell, half of which is solved in space
  static constexpr int kParts = 8;
  static constexpr double kStiller = 20;  // springs that hold what is not in balance, over those of the load

  /// m, x of the deformed body's centroid.
  double middle() const {
    double volume = 0, sum = 0;
    for (const auto& element : body_->mesh().elements) {
      Eigen::Matrix<double, Dim, Dim> edges;
      double middle = 0;
      const auto deformed = [&](int corner) {
        return Eigen::Matrix<double, Dim, 1>(body_->mesh().nodes[element[corner]] +
                                             path_->state().template segment<Dim>(Dim * element[corner]));
      };
      for (int corner = 0; corner <= Dim; ++corner) {
        middle += deformed(corner)[0] / (Dim + 1);
        if (corner > 0) edges.col(corner - 1) = deformed(corner) - deformed(0);
      }
      volume += edges.determinant();
      sum += edges.determinant() * middle;
    }
    return sum / volume;
  }

  Constraints constraints() const {
    Constraints result;
    result.entries.assign(body_->stateSize(), Constraints::kFree);
    std::fill_n(result.entries.end() - 3 - body_->pressureCount(), body_->pressureCount(), Constraints::kInternal);
    for (int k = 0; k < 2; ++k) result.entries[body_->tipEntry() + k] = Constraints::tip(k);
    result.entries.back() = seat_ ? Constraints::tip(kStill) : Constraints::kFixed;
    constexpr int kAcross = Dim == 3 ? 1 : 0;  // of the plane of symmetry, of the axis
    for (std::size_t node = 0; node < body_->mesh().nodes.size(); ++node) {
      if (body_->mesh().nodes[node][kAcross] == 0) result.entries[Dim * node + kAcross] = Constraints::kFixed;
    }
    return result;
  }

  double radius_, stiffness_;
  std::shared_ptr<LayeredBody<Dim>> body_;
  std::shared_ptr<RigidContact<Dim>> lip_;
  std::shared_ptr<SuctionLoad<Dim>> suction_;
  std::shared_ptr<Harness<Dim>> harness_;
  std::shared_ptr<SlidingSeat> seat_;
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
  LoadPath::Result result_;
};

/// Pull along the tube; push across it; needle along it beside the axis (radii), which turns the cell.
HeldLoad pull() { return {"pull", {0, 0, 0}, {0, 0, 1}, 0}; }
HeldLoad push() { return {"push", {0, 0, 0}, {1, 0, 0}, 0}; }
HeldLoad needle(double radius, double beside, double friction) {
  return {"needle", radius * Vector3d(beside, 0, std::sqrt(1 - beside * beside)), {0, 0, -1}, friction};
}

class SlipTable {
 public:
  SlipTable(double level, int segments, bool verbose) : level_(level), segments_(segments), verbose_(verbose) {
    table_.add(
        "scene,load,friction,suction_over_modulus,solved_nN,opens_nN,end,point_x_um,point_z_um,limit_nN,limit_over_"
        "solved,"
        "rigid_nN,motion_nN,still_nN,unknowns\n");
  }

  template <int Dim>
  void add(const HeldScene& held, const HeldLoad& load) {
    LoadedCell<Dim> cell(held, load, Dim == 2 ? level_ + kFiner : level_, segments_);
    Limit found;
    Vector3d at = load.point;
    found.end = cell.inEquilibrium() ? "" : "not held: " + cell.reason();
    for (int i = 0; i < kMostSteps && found.end.empty(); ++i) {
      const double before = cell.force();
      cell.drive();
      found.solved = std::max(found.solved, cell.force());
      if (std::isnan(found.opens) && cell.pressedShare() < 1) found.opens = cell.force();
      if (!cell.inEquilibrium()) found.end = "lost: " + cell.reason();
      if (i > 2 && cell.force() - before < kPlateau * cell.forceOfStep()) found.end = "slides";
      const auto now = cell.loaded();
      // Without friction the cell turns until the load passes through its centre.
      if (found.end.empty() && load.friction > 0) at = {now[0], 0, now[Dim - 1]};
      if (verbose_) tell(cell);
    }
    if (found.end.empty()) found.end = "still held";
    found.limit = load.largest(held.soft(load.friction), at);
    found.rigid = load.largest(held.rigid(load.friction), at);
    if (load.friction == 0) found.motion = comesOff(held, load, at);
    write(held, load, at, found, cell.unknowns());
  }

  /// The load at which a cell that turns in its seat is in balance. Friction grows over the first steps.
  void addTurned(const HeldScene& held, const HeldLoad& load) {
    LoadedCell<3> cell(held, load, level_ + kFinerTurned, segments_, LoadedCell<3>::Friction::kTurning);
    Limit found;
    found.end = cell.inEquilibrium() ? "" : "not held: " + cell.reason();
    Vector3d at = load.point;
    for (int i = 1; i < kMostSteps && found.end.empty(); ++i) {
      const double force = cell.force(), moment = cell.turningMoment();
      const Vector3d before = cell.loaded();
      cell.drive();
      if (verbose_) tell(cell);
      if (!cell.inEquilibrium()) found.end = "lost: " + cell.reason();
      if (i + 1 == kMostSteps) at = cell.loaded();
      if (!found.end.empty() || i <= kGrowing || cell.turningMoment() < 0) continue;
      if (moment > 0) found.end = "turns before all of the friction acts";
      if (!found.end.empty()) continue;
      const double share = moment / (moment - cell.turningMoment());
      found.solved = force + share * (cell.force() - force);
      found.still = cell.stillForce();
      at = before + share * (Vector3d(cell.loaded()) - before);
      found.end = "slides";
    }
    if (found.end.empty()) found.end = "still held";
    found.limit = load.largest(held.soft(load.friction), at);
    found.rigid = load.largest(held.rigid(load.friction), at);
    found.motion = comesOff(held, load, at);
    write(held, {"turned", load.point, load.direction, load.friction}, at, found, cell.unknowns());
  }

  /// As a push across the tube at the pole, of which the moment is that times the radius.
  void addTurning(const HeldScene& held, double friction) {
    const LoadedCell<2> cell(held, pull(), level_ + kFiner, segments_);
    Limit found;
    found.solved = cell.turning(friction) / held.radius;
    found.limit = held.soft(friction).turning() / held.radius;
    found.rigid = held.rigid(friction).turning() / held.radius;
    found.end = cell.inEquilibrium() ? "slides" : "not held: " + cell.reason();
    write(held, {"turn", {0, 0, held.radius}, {1, 0, 0}, friction}, {0, 0, held.radius}, found, cell.unknowns());
  }

  const std::string& text() const { return table_.text(); }

 private:
  static constexpr double kFiner = 2.5;      // level of a section's mesh above that in space
  static constexpr double kFinerTurned = 1;  // same, of a cell that turns: on a coarser one it loses its equilibrium

  struct Limit {
    double solved = 0, opens = NAN;             // N, of the solved cell: the largest; a part of the lip is free
    double limit = 0, rigid = 0, motion = NAN;  // N, of HoldLimits, of a rigid sphere's, of CellMotion
    double still = NAN;                         // N, that still holds a cell which should turn
    std::string end{};
  };

  /// N, of a load that grows in steps of 0.5 % of the rigid sphere's limit: the cell comes off or, with friction,
  /// slips.
  static double comesOff(const HeldScene& held, const HeldLoad& load, const Vector3d& at) {
    CellMotionConfig config = held.motion(load.friction);
    config.dish_height = -1;
    config.density_difference = 0;
    const PipetteMouth mouth = held.mouth(1);
    CellMotion motion(config, mouth, {});
    CellMotionInput input;  // z points into the pipette
    input.pressure = -held.suction * kModulus;
    motion.place({0, 0, -mouth.touchDistance(held.radius)}, Eigen::Quaterniond::Identity(), input);
    const double expected = load.largest(held.rigid(load.friction), at);
    const Vector3d mirrored(1, 1, -1), start = motion.state().position;
    for (double share = 0.3; share < 1.5; share += 0.005) {
      input.force = share * expected * load.direction.cwiseProduct(mirrored);
      for (int i = 0; i < 100; ++i) {
        const Vector3d arm = at.cwiseProduct(mirrored) - (motion.state().position - start);
        input.torque = arm.cross(input.force);
        motion.step(1e-3, input);
      }
      const CellMode mode = motion.state().mode;
      if (mode != CellMode::kHeld && (load.friction > 0 || mode != CellMode::kSlipping)) return share * expected;
    }
    return NAN;
  }

  void write(const HeldScene& held, const HeldLoad& load, const Vector3d& at, const Limit& found, int unknowns) {
    std::string end = found.end;
    std::replace(end.begin(), end.end(), ',', ';');
    char row[400];
    std::snprintf(row, sizeof row, "%s,%s,%g,%g,%.4g,%.4g,%s,%.3g,%.3g,%.4g,%.3f,%.4g,%.4g,%.2g,%d\n", held.name,
                  load.name, load.friction, held.suction, 1e9 * found.solved, 1e9 * found.opens, end.c_str(),
                  1e6 * at.x(), 1e6 * at.z(), 1e9 * found.limit, found.limit / found.solved, 1e9 * found.rigid,
                  1e9 * found.motion, 1e9 * found.still, unknowns);
    table_.add(row);
  }

  template <int Dim>
  static void tell(const LoadedCell<Dim>& cell) {
    const auto at = cell.loaded();
    std::fprintf(stderr, "  %.4g nN at (%.3g, %.3g) um, lip %.2g, seal %.4g um, turned by %.4g nN um, still %.4g nN\n",
                 1e9 * cell.force(), 1e6 * at[0], 1e6 * at[Dim - 1], cell.pressedShare(), 1e6 * cell.sealRadius(),
                 1e15 * cell.turningMoment(), 1e9 * cell.stillForce());
  }

  PrintedTable table_;
  double level_;
  int segments_;
  bool verbose_;
};

/// The distance of LipSuction::releasedRadius was fitted to A to E.
constexpr HeldScene kHeldScenes[] = {{"A", 40e-6, 14e-6, 40e-6, 8e-6, 0.05},   {"B", 40e-6, 14e-6, 40e-6, 8e-6, 0.15},
                                     {"C", 40e-6, 20e-6, 45e-6, 8e-6, 0.05},   {"D", 40e-6, 10e-6, 40e-6, 5e-6, 0.1},
                                     {"E", 40e-6, 10e-6, 41e-6, 2.5e-6, 0.11}, {"F", 40e-6, 12e-6, 32e-6, 4e-6, 0.02},
                                     {"G", 30e-6, 9e-6, 24e-6, 2e-6, 0.08},    {"H", 60e-6, 20e-6, 50e-6, 6e-6, 0.12}};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  double level = -1;
  int segments = 4;
  double friction = 0.15;
  std::string scenes = "ABCDEFGH", loads = "turn,pull,push";
  std::vector<double> beside{0.4, 0.6};
  bool verbose = false;
  namespace po = boost::program_options;
  po::options_description more;
  more.add_options()("level", po::value(&level)->default_value(level), "of the mesh (scene_mesh.h)");
  more.add_options()("segments", po::value(&segments)->default_value(segments), "of the mesh, around half of the axis");
  more.add_options()("friction", po::value(&friction)->default_value(friction), "of the lip, under a needle");
  more.add_options()("beside", po::value(&beside)->multitoken(),
                     "places of a needle beside the axis, in radii; default 0.4 0.6");
  more.add_options()("scenes", po::value(&scenes)->default_value(scenes), "letters");
  more.add_options()("loads", po::value(&loads)->default_value(loads),
                     "turn, pull (in a section), push, needle, turned (in space)");
  more.add_options()("verbose", po::bool_switch(&verbose), "the way to each limit, too");
  return benchMain(
      argc, argv, "slip: what suction bears of a soft cell, solved in space, against HoldLimits",
      [&] {
        const auto asked = [&](const std::string& load) {
          return ("," + loads + ",").find("," + load + ",") != std::string::npos;
        };
        SlipTable table(level, segments, verbose);
        for (const HeldScene& held : kHeldScenes) {
          if (scenes.find(held.name) == std::string::npos) continue;
          if (asked("turn")) table.addTurning(held, 0.3);
          if (asked("pull")) table.add<2>(held, pull());
          if (asked("push")) table.add<3>(held, push());
          for (const double place : beside) {
            if (asked("turned")) table.addTurned(held, needle(held.radius, place, friction));
            if (asked("needle")) table.add<3>(held, needle(held.radius, place, friction));
          }
        }
        return table.text();
      },
      more);
}
