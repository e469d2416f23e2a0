#include "cell/model/pierced_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cell/contact/rigid_contact.h"
#include "cell/contact/rounded_tip.h"
#include "cell/mechanics/cohesive_wall.h"
#include "cell/mechanics/relaxation.h"
#include "cell/mechanics/surface_tension.h"
#include "cell/mesh/pierced_section.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {
namespace {

constexpr double kSlipRange = 0.01;     ///< in the tip's radius
constexpr double kStiffContact = 3000;  ///< in Young's moduli over the tip's radius
constexpr double kHardening = 1e-3;     ///< of the contact, in the tip's radius

// Of the needle that grows in its hole, in radii of the tip.
constexpr double kThin = 0.98;     ///< at first, over the hole
constexpr double kGrowth = 0.03;   ///< in a step
constexpr double kFurther = 0.3;   ///< along the axis, at most, in a step
constexpr double kInto = 0.02;     ///< at least, beyond the hole's bottom
constexpr double kFelt = 1e-2;     ///< over the last force: from here on the depth follows the force
constexpr double kGap = 0.5;       ///< below the tip: with more it is being pushed out
constexpr double kJump = 4e-3;     ///< step across an instability
constexpr int kJumps = 12;         ///< in one step
constexpr int kIterations = 400;   ///< of one jump
constexpr double kDeepest = 1.75;  ///< depth, over the cell's radius
constexpr double kAround = 0.5;    ///< opening of a rim that has the needle within it, over the needle's

constexpr double kOnRim = 1e-6;  ///< of the hole's radius

// Of a wall that is held closed, in radii of the tip.
constexpr double kCohesiveRim = 0.2;    ///< fillet: at a sharp edge its tractions would have no finite resultant
constexpr double kCohesiveSize = 0.07;  ///< of the elements, at most
constexpr double kSizeOfOpening = 0.9;  ///< same, over the opening of the largest traction
constexpr double kCohesiveDepth = 3.5;  ///< of these elements
constexpr double kClosed = 500;         ///< stiffness of the closed wall, in shear moduli over the tip's radius

PiercedSectionConfig sectionOf(const PiercedCellConfig& config) {
  const double fine = std::pow(2, -config.level), tip = config.tip_radius;
  PiercedSectionConfig section;
  section.radii.clear();
  for (const Scene::Layer& layer : config.layers) section.radii.push_back(layer.outer_radius);
  section.hole_radius = config.hole_radius;
  section.hole_length = config.hole_length;
  section.contact_radius = 1.4 * tip;
  section.held_radius = config.held_radius;
  section.hole_size = fine * std::min(config.hole_radius / 2, tip / 4);
  if (config.cohesion) {
    section.rim_radius = kCohesiveRim * tip;
    section.hole_size = fine * std::min(kCohesiveSize * tip, kSizeOfOpening * config.cohesion->opening);
    section.contact_radius = 0;
    section.fine_length = kCohesiveDepth * tip;
  }
  section.held_size = fine * config.held_radius / 4;
  section.size = config.radius() / 6 * std::sqrt(fine);
  return section;
}

std::vector<std::shared_ptr<const Material>> materialsOf(const PiercedCellConfig& config) {
  std::vector<std::shared_ptr<const Material>> materials;
  for (const Scene::Layer& layer : config.layers) materials.push_back(makeMaterial(layer.material));
  return materials;
}

double largestModulus(const PiercedCellConfig& config) {
  double modulus = 0;
  for (const Scene::Layer& layer : config.layers) modulus = std::max(modulus, layer.material.young_modulus);
  return modulus;
}

}  // namespace

PiercedCell::PiercedCell(const PiercedCellConfig& config)
    : config_(config),
      body_(std::make_shared<LayeredBody<2>>(makePiercedSection(sectionOf(config)), ElementKind::kP2P0,
                                             materialsOf(config))) {
  const RoundedTip tip = RoundedTip::make("hemisphere", config.tip_radius, 0);
  RigidContactConfig contact;
  contact.mode = config.sticking ? RigidContactConfig::Mode::kSticking : RigidContactConfig::Mode::kSliding;
  contact.friction = config.friction;
  contact.slip_range = kSlipRange * config.tip_radius;
  if (contact.mode == RigidContactConfig::Mode::kSliding && contact.friction == 0)
    contact.hardening = kHardening * config.tip_radius;
  contact.penalty = kStiffContact * largestModulus(config) / config.tip_radius;
  contact.origin.z() = tip.touchHeight(config.radius(), Eigen::Vector2d::Zero());
  contact_ = std::make_shared<RigidContact<2>>(*body_, std::make_shared<RoundedTip>(tip), contact);
  EquilibriumSystem::Terms terms = {body_, contact_};
  bool at_rest = true;
  for (std::size_t i = 0; i < config.layers.size(); ++i) {
    const Scene::Layer& layer = config.layers[i];
    if (layer.surface_tension == 0) continue;
    terms.push_back(
        std::make_shared<SurfaceTension<2>>(*body_, static_cast<int>(i), layer.outer_radius, layer.surface_tension));
    at_rest = at_rest && config.hole_length == 0;
  }
  if (config.cohesion) {
    const double shear = config.layers.front().material.young_modulus / 3;
    terms.push_back(std::make_shared<CohesiveWall>(
        *body_, CohesiveWallConfig{config.hole_radius, config.cohesion->toughness, config.cohesion->opening,
                                   kClosed * shear / config.tip_radius}));
  }
  system_ =
      std::make_unique<EquilibriumSystem>(std::move(terms), constraints(config), SymmetricSolver::Method::kSimplicial);
  path_config_.length = 2 * config.radius();
  path_config_.first_step = config.tip_radius / 40;
  path_config_.largest_step = config.tip_radius / 6;
  path_config_.smallest_step = 1e-5 * config.tip_radius;
  path_config_.smooth = false;
  path_config_.easy = 8;
  Eigen::VectorXd start = Eigen::VectorXd::Zero(body_->stateSize());
  if (!at_rest) {
    const Relaxation::Result result = Relaxation(*system_, {path_config_.length, kIterations}).relax(start);
    if (!result.converged)
      throw NotAtRest("the pierced cell does not come to rest under its surfaces' tension: " + result.reason);
  }
  path_ = std::make_unique<LoadPath>(*system_, path_config_, start);
  const auto& nodes = body_->mesh().nodes;
  for (int node = 0; node < static_cast<int>(nodes.size()); ++node) {  // the highest on the axis
    if (nodes[node].x() == 0 && (bottom_ < 0 || nodes[node].y() > nodes[bottom_].y())) bottom_ = node;
    const bool on_rim = config.hole_length > 0 && std::abs(nodes[node].x() / config.hole_radius - 1) < kOnRim;
    if (on_rim && (rim_ < 0 || nodes[node].y() > nodes[rim_].y())) rim_ = node;
  }
}

PiercedCell::~PiercedCell() = default;

Constraints PiercedCell::constraints(const PiercedCellConfig& config) const {
  Constraints result;
  result.entries.assign(body_->stateSize(), Constraints::kFree);
  std::fill_n(result.entries.end() - 3 - body_->pressureCount(), body_->pressureCount(), Constraints::kInternal);
  for (int k = 0; k < 3; ++k)
    result.entries[body_->tipEntry() + k] = k == 1 ? Constraints::kFixed : Constraints::tip(k);
  const auto& nodes = body_->mesh().nodes;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (nodes[node].x() == 0) result.entries[2 * node] = Constraints::kFixed;
  }
  constexpr double kWithin = 1 + 1e-9;
  for (const auto& facet : body_->mesh().facets) {
    bool held = true;
    for (int corner = 0; corner < 2; ++corner) {
      const Eigen::Vector2d& at = nodes[facet.nodes[corner]];
      held = held && at.y() < 0 && at.x() <= kWithin * config.held_radius && at.norm() > 0.999 * config.radius();
    }
    for (const int node : facet.nodes) {
      for (int k = 0; held && k < 2; ++k) result.entries[2 * node + k] = Constraints::kFixed;
    }
  }
  return result;
}

bool PiercedCell::advance(double depth) { return follow({0, 0, -depth}); }

bool PiercedCell::insert(double force, double pressing) {
  const double tip = config_.tip_radius, hole = config_.hole_radius, shallowest = config_.hole_length + kInto * tip;
  const HoleExpansion expansion(materialAtBottom(), config_.radius() / tip);
  const auto opened = [&](double radius) {  // N, with which a long hole pushes a shaft of this radius out
    return radius > hole ? radius * radius * expansion.at(hole / radius).energy : 0;
  };
  const double last = opened(tip);
  double radius = kThin * hole, depth = shallowest;
  if (!lead({radius - tip, 0, 0}) || !lead({radius - tip, 0, -depth})) return false;
  while (radius < tip) {
    const double next = std::min(tip, radius + kGrowth * tip), wanted = pressing * opened(next);
    if (wanted > kFelt * last) {
      const Eigen::Matrix3d& stiffness = path_->stiffness();
      const double missing = wanted + path_->reaction().z() + stiffness(2, 0) * (next - radius);
      const double deeper = stiffness(2, 2) > 0 ? missing / stiffness(2, 2) : kFurther * tip;
      depth = std::max(shallowest, depth + std::clamp(deeper, -kFurther * tip, kFurther * tip));
    }
    if (!lead({next - tip, 0, -depth}) || (wanted > kFelt * last && !isAtBottom())) return false;
    radius = next;
  }
  while (this->force() < force && depth < kDeepest * config_.radius() && lead({0, 0, -depth})) depth += kFurther * tip;
  return isAtBottom() && isInside();
}

const Material& PiercedCell::materialAtBottom() const {
  std::size_t layer = 0;
  while (layer + 1 < config_.layers.size() &&
         config_.layers[layer + 1].outer_radius > config_.radius() - config_.hole_length)
    ++layer;
  return *body_->materials()[layer];
}

bool PiercedCell::follow(const Eigen::Vector3d& target) {
  const LoadPath::Result result = path_->advance(target - start_);
  reason_ = result.reason;
  return result.converged;
}

/// Elements at a wall that is stretched by far wrinkle, and the rim snaps over the tip.
bool PiercedCell::lead(const Eigen::Vector3d& target) {
  for (int jumps = 0; jumps < kJumps; ++jumps) {
    if (follow(target)) return true;
    if (!jump(target)) return false;
  }
  return false;
}

/// Steps on towards the target and comes to rest at the next equilibrium downhill.
bool PiercedCell::jump(const Eigen::Vector3d& target) {
  const Eigen::Vector3d from = place(), left = target - from;
  const Eigen::Vector3d step = std::min(1.0, kJump * config_.tip_radius / left.norm()) * left;
  Eigen::VectorXd state = path_->state();
  system_->addTo(state, Eigen::VectorXd::Zero(system_->freeSize()), step);
  const Relaxation::Result result = Relaxation(*system_, {path_config_.length, kIterations}).relax(state);
  if (!result.converged) return false;
  start_ = from + step;
  path_ = std::make_unique<LoadPath>(*system_, path_config_, state);
  return true;
}

Eigen::Vector3d PiercedCell::place() const { return start_ + path_->translation(); }
bool PiercedCell::isAtBottom() const { return bottom() - depth() < kGap * config_.tip_radius; }
bool PiercedCell::isInside() const { return mouthOpening() > kAround * (config_.tip_radius - config_.hole_radius); }
double PiercedCell::mouthOpening() const { return path_->state()[2 * rim_]; }
double PiercedCell::force() const { return -path_->reaction().z(); }
double PiercedCell::energy() const { return path_->energy(); }
double PiercedCell::depth() const { return -place().z(); }
double PiercedCell::penetration() const { return contact_->penetration(); }
int PiercedCell::unknowns() const { return system_->freeSize(); }
double PiercedCell::bottom() const {
  return config_.radius() - body_->mesh().nodes[bottom_].y() - path_->state()[2 * bottom_ + 1];
}
std::vector<Eigen::Vector2d> PiercedCell::places() const {
  std::vector<Eigen::Vector2d> result = body_->mesh().nodes;
  for (std::size_t node = 0; node < result.size(); ++node) result[node] += path_->state().segment<2>(2 * node);
  return result;
}

}  // namespace microinjection
