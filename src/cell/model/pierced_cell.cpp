#include "cell/model/pierced_cell.h"

#include <cmath>

#include "cell/contact/rigid_contact.h"
#include "cell/contact/rounded_tip.h"
#include "cell/mesh/pierced_section.h"

namespace microinjection {
namespace {

constexpr double kSlipRange = 0.01;     ///< in the tip's radius
constexpr double kStiffContact = 3000;  ///< in Young's moduli over the tip's radius

PiercedSectionConfig sectionOf(const PiercedCellConfig& config) {
  const double fine = std::pow(2, -config.level);
  PiercedSectionConfig section;
  section.radius = config.radius;
  section.hole_radius = config.hole_radius;
  section.hole_length = config.hole_length;
  section.contact_radius = 1.4 * config.tip_radius;
  section.held_radius = config.held_radius;
  section.hole_size = fine * std::min(config.hole_radius / 2, config.tip_radius / 4);
  section.held_size = fine * config.held_radius / 4;
  section.size = config.radius / 6 * std::sqrt(fine);
  return section;
}

std::vector<std::shared_ptr<const Material>> onlyLayer(const MaterialConfig& material) {
  std::vector<std::shared_ptr<const Material>> layers;
  layers.push_back(makeMaterial(material));
  return layers;
}

}  // namespace

PiercedCell::PiercedCell(const PiercedCellConfig& config)
    : body_(std::make_shared<LayeredBody<2>>(makePiercedSection(sectionOf(config)), ElementKind::kP2P0,
                                             onlyLayer(config.material))) {
  const RoundedTip tip = RoundedTip::make("hemisphere", config.tip_radius, 0);
  RigidContactConfig contact;
  contact.mode = config.sticking ? RigidContactConfig::Mode::kSticking : RigidContactConfig::Mode::kSliding;
  contact.friction = config.friction;
  contact.slip_range = kSlipRange * config.tip_radius;
  contact.penalty = kStiffContact * config.material.young_modulus / config.tip_radius;
  contact.origin.z() = tip.touchHeight(config.radius, Eigen::Vector2d::Zero());
  contact_ = std::make_shared<RigidContact<2>>(*body_, std::make_shared<RoundedTip>(tip), contact);
  system_ = std::make_unique<EquilibriumSystem>(EquilibriumSystem::Terms{body_, contact_}, constraints(config),
                                                SymmetricSolver::Method::kSimplicial);
  LoadPathConfig path;
  path.length = 2 * config.radius;
  path.first_step = config.tip_radius / 40;
  path.largest_step = config.tip_radius / 6;
  path.smallest_step = 1e-5 * config.tip_radius;
  path.smooth = false;
  path.easy = 8;
  path_ = std::make_unique<LoadPath>(*system_, path);
  const auto& nodes = body_->mesh().nodes;
  for (int node = 0; node < static_cast<int>(nodes.size()); ++node) {  // the highest on the axis
    if (nodes[node].x() == 0 && (bottom_ < 0 || nodes[node].y() > nodes[bottom_].y())) bottom_ = node;
  }
  touch_height_ = config.radius;
  thinner_ = config.tip_radius - 0.98 * config.hole_radius;
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
      held = held && at.y() < 0 && at.x() <= kWithin * config.held_radius && at.norm() > 0.999 * config.radius;
    }
    for (const int node : facet.nodes) {
      for (int k = 0; held && k < 2; ++k) result.entries[2 * node + k] = Constraints::kFixed;
    }
  }
  return result;
}

bool PiercedCell::advance(double depth) {
  const LoadPath::Result result = path_->advance({0, 0, -depth});
  reason_ = result.reason;
  return result.converged;
}

bool PiercedCell::insert(double depth) {
  LoadPath::Result result;
  for (const Eigen::Vector3d& target :
       {Eigen::Vector3d(-thinner_, 0, 0), Eigen::Vector3d(-thinner_, 0, -depth), Eigen::Vector3d(0, 0, -depth)}) {
    result = path_->advance(target);
    if (!result.converged) break;
  }
  reason_ = result.reason;
  return result.converged;
}

double PiercedCell::force() const { return -path_->reaction().z(); }
double PiercedCell::energy() const { return path_->energy(); }
double PiercedCell::depth() const { return -path_->translation().z(); }
double PiercedCell::penetration() const { return contact_->penetration(); }
int PiercedCell::unknowns() const { return system_->freeSize(); }
double PiercedCell::bottom() const {
  return touch_height_ - body_->mesh().nodes[bottom_].y() - path_->state()[2 * bottom_ + 1];
}
std::vector<Eigen::Vector2d> PiercedCell::places() const {
  std::vector<Eigen::Vector2d> result = body_->mesh().nodes;
  for (std::size_t node = 0; node < result.size(); ++node) result[node] += path_->state().segment<2>(2 * node);
  return result;
}

}  // namespace microinjection
