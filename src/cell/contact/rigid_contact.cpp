#include "cell/contact/rigid_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cell/mechanics/reference_element.h"

namespace microinjection {
namespace {

/// Largest penetration expected at the next equilibrium: factor on the present one, and share of
/// the tip's radius.
constexpr double kDeeper = 1.5;
constexpr double kDeepestFirst = 1e-4;

/// Gap of the undeformed surface, over the tip's radius, up to which it may come into contact in the
/// depths that are solved. Where more does, the solver only loses time.
constexpr double kNear = 0.7;

/// Gap over the range of adhesion at which a point is released. The traction is then 1e-7 of the
/// largest.
constexpr double kFree = 20;

/// Penetration, over the hardening, from which the penalty grows no more.
constexpr double kHardest = 40;

/// A section's (r, z) is the point (r, 0, z) in space.
Eigen::Vector3d inSpace(const Eigen::Vector2d& v) { return {v[0], 0, v[1]}; }
Eigen::Vector3d inSpace(const Eigen::Vector3d& v) { return v; }

template <int Dim>
Eigen::Matrix<double, Dim, 1> fromSpace(const Eigen::Vector3d& v) {
  if constexpr (Dim == 2) {
    return {v[0], v[2]};
  } else {
    return v;
  }
}

/// Area of the body's surface per unit of the reference facet.
double areaDensity(const Eigen::Matrix<double, 2, 1>& tangent, const Eigen::Vector2d& x) {
  return 2 * M_PI * x[0] * tangent.norm();
}
double areaDensity(const Eigen::Matrix<double, 3, 2>& tangents, const Eigen::Vector3d&) {
  return tangents.col(0).cross(tangents.col(1)).norm();
}

}  // namespace

template <int Dim>
RigidContact<Dim>::RigidContact(const LayeredBody<Dim>& body, std::shared_ptr<const RigidSurface> surface,
                                const RigidContactConfig& config)
    : surface_(std::move(surface)), config_(config) {
  for (int k = 0; k < Dim; ++k) {
    if (config_.moves[Dim == 2 ? 2 * k : k]) moving_.push_back(k);
  }
  for (const auto& facet : body.mesh().facets) {
    if (facet.outer) addFacet(body, facet);
  }
  reset();
}

template <int Dim>
void RigidContact<Dim>::addFacet(const LayeredBody<Dim>& body, const typename QuadraticMesh<Dim>::Facet& facet) {
  const bool quadratic = isQuadratic(body.kind());
  Facet result;
  result.nodes = quadratic ? QuadraticMesh<Dim>::kFacetNodes : Dim;
  for (int a = 0; a < result.nodes; ++a) {
    for (int k = 0; k < Dim; ++k) result.entries.push_back(Dim * facet.nodes[a] + k);
  }
  for (const int k : moving_) result.entries.push_back(body.tipEntry() + (Dim == 2 ? 2 * k : k));
  for (const ReferenceElement::Point& at : referenceFacet<Dim>().points) {
    Vector x = Vector::Zero();
    Eigen::Matrix<double, Dim, Dim - 1> tangents = Eigen::Matrix<double, Dim, Dim - 1>::Zero();
    for (int a = 0; a < QuadraticMesh<Dim>::kFacetNodes; ++a) {
      x += at.shape[a] * body.mesh().nodes[facet.nodes[a]];
      tangents += body.mesh().nodes[facet.nodes[a]] * at.gradient.row(a);
    }
    if (!quadratic) {  // a straight facet: displacement and geometry are linear
      x.setZero();
      for (int a = 0; a < Dim; ++a) x += at.barycentric[a] * body.mesh().nodes[facet.nodes[a]];
    }
    Point point;
    point.undeformed = x - fromSpace<Dim>(config_.origin);
    point.weight = at.weight * areaDensity(tangents, x);
    point.shape = quadratic ? at.shape : at.barycentric;
    result.points.push_back(point);
    result.near = result.near || surface_->distance(inSpace(point.undeformed)) < kNear * surface_->size();
  }
  facets_.push_back(std::move(result));
}

template <int Dim>
double RigidContact<Dim>::gap(const Vector& at, Vector& normal, Matrix& curvature) const {
  const Gap gap = surface_->gap(inSpace(at));
  normal = fromSpace<Dim>(gap.normal);
  for (int k = 0; k < Dim; ++k) {
    for (int l = 0; l < Dim; ++l) curvature(k, l) = gap.curvature(Dim == 2 ? 2 * k : k, Dim == 2 ? 2 * l : l);
  }
  return gap.distance;
}

template <int Dim>
typename RigidContact<Dim>::Vector RigidContact<Dim>::relative(const Facet& facet, const Point& point,
                                                               const Eigen::VectorXd& state) const {
  Vector at = point.undeformed;
  for (int a = 0; a < facet.nodes; ++a) {
    for (int k = 0; k < Dim; ++k) at[k] += point.shape[a] * state[facet.entries[Dim * a + k]];
  }
  for (std::size_t i = 0; i < moving_.size(); ++i) at[moving_[i]] -= state[facet.entries[Dim * facet.nodes + i]];
  return at;
}

template <int Dim>
typename RigidContact<Dim>::Pressing RigidContact<Dim>::pressing(double penetration) const {
  const double penalty = config_.penalty, range = config_.hardening;
  if (range == 0) return {0.5 * penalty * penetration * penetration, penalty * penetration, penalty};
  const double inside = std::min(penetration / range, kHardest), on = penetration - inside * range;
  const double more = std::expm1(inside), stiffness = penalty * (more + 1), traction = penalty * range * more;
  const double energy = penalty * range * range * (more - inside);
  return {energy + (traction + 0.5 * stiffness * on) * on, traction + stiffness * on, stiffness};
}

template <int Dim>
bool RigidContact<Dim>::contribution(const Point& point, const Vector& at, Local& local) const {
  const bool stuck = config_.mode == RigidContactConfig::Mode::kSticking && point.memory.touching;
  if (stuck) {
    const double stiffness = config_.penalty * point.weight;
    const Vector stretch = at - point.memory.anchor;
    local.energy = 0.5 * stiffness * stretch.squaredNorm();
    local.gradient = stiffness * stretch;
    local.hessian = stiffness * Matrix::Identity();
    return true;
  }
  const double distance = surface_->distance(inSpace(at));
  const bool with_friction = config_.friction > 0 && point.memory.touching;
  const bool adhering = distance > 0 && point.memory.bonded;
  if (distance >= 0 && !with_friction && !adhering) return false;
  local = Local();
  if (adhering) addAdhesion(point, at, local);
  if (distance < 0) {
    Vector normal;
    Matrix curvature;
    gap(at, normal, curvature);
    const Pressing now = pressing(-distance);
    local.energy = point.weight * now.energy;
    local.gradient = -point.weight * now.traction * normal;
    // During the iterations a point may be so far inside that the true second derivative is
    // negative.
    const double deepest = kDeeper * deepest_ + kDeepestFirst * surface_->size();
    const double bending = distance < -deepest ? pressing(deepest).traction : now.traction;
    local.hessian = point.weight * (now.stiffness * normal * normal.transpose() - bending * curvature);
  }
  if (with_friction) addFriction(point, at, local);
  return true;
}

template <int Dim>
double RigidContact<Dim>::slipStiffness(const Memory& memory) const {
  const double bound = config_.friction * memory.traction;
  return config_.slip_range > 0 ? std::min(config_.penalty, bound / config_.slip_range) : config_.penalty;
}

/// Elastic up to the bound of Coulomb's law, then of constant force: Huber's function of the slip.
template <int Dim>
void RigidContact<Dim>::addFriction(const Point& point, const Vector& at, Local& local) const {
  const Matrix tangential = Matrix::Identity() - point.memory.normal * point.memory.normal.transpose();
  const Vector slip = tangential * (at - point.memory.anchor);
  const double bound = config_.friction * point.memory.traction * point.weight,
               stiffness = slipStiffness(point.memory) * point.weight;
  const double length = slip.norm();
  if (stiffness * length <= bound) {
    local.energy += 0.5 * stiffness * length * length;
    local.gradient += stiffness * slip;
    local.hessian += stiffness * tangential;
    return;
  }
  const Vector direction = slip / length;
  local.energy += bound * length - 0.5 * bound * bound / stiffness;
  local.gradient += bound * direction;
  local.hessian += bound / length * (tangential - direction * direction.transpose());
}

template <int Dim>
void RigidContact<Dim>::addAdhesion(const Point& point, const Vector& at, Local& local) const {
  Vector normal;
  Matrix curvature;
  const double range = config_.adhesion_range, open = gap(at, normal, curvature) / range;
  const double scale = config_.adhesion * point.weight, fading = std::exp(-open);
  const double pull = scale / range * open * fading;
  local.energy += scale * (1 - (1 + open) * fading);
  local.gradient += pull * normal;
  local.hessian += scale / (range * range) * (1 - open) * fading * normal * normal.transpose() + pull * curvature;
}

template <int Dim>
bool RigidContact<Dim>::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Facet& facet = facets_[index];
  const int nodes = facet.nodes, moving = static_cast<int>(moving_.size()), size = Dim * nodes + moving;
  result.zero = true;
  for (const Point& point : facet.points) {
    Local local;
    if (!contribution(point, relative(facet, point, state), local)) continue;
    if (result.zero) {
      result.zero = false;
      result.energy = 0;
      if (order != Order::kEnergy) result.gradient.setZero(size);
      if (order == Order::kHessian) result.hessian.setZero(size, size);
    }
    result.energy += local.energy;
    if (order == Order::kEnergy) continue;
    // The relative position moves with the nodes' shape functions, and opposite to the tip.
    for (int a = 0; a < nodes; ++a) {
      result.gradient.template segment<Dim>(Dim * a) += point.shape[a] * local.gradient;
      for (int b = 0; order == Order::kHessian && b < nodes; ++b) {
        result.hessian.template block<Dim, Dim>(Dim * a, Dim * b) += point.shape[a] * point.shape[b] * local.hessian;
      }
    }
    for (int i = 0; i < moving; ++i) {
      const int own = Dim * nodes + i, k = moving_[i];
      result.gradient[own] -= local.gradient[k];
      if (order != Order::kHessian) continue;
      for (int a = 0; a < nodes; ++a) {
        result.hessian.template block<Dim, 1>(Dim * a, own) -= point.shape[a] * local.hessian.col(k);
        result.hessian.template block<1, Dim>(own, Dim * a) -= point.shape[a] * local.hessian.row(k);
      }
      for (int j = 0; j < moving; ++j) result.hessian(own, Dim * nodes + j) += local.hessian(k, moving_[j]);
    }
  }
  return true;
}

template <int Dim>
bool RigidContact<Dim>::settle(Memory& memory, const Vector& at) const {
  Vector normal;
  Matrix curvature;
  const double distance = gap(at, normal, curvature);
  const bool was_touching = memory.touching;
  if (config_.mode == RigidContactConfig::Mode::kSticking) {
    if (was_touching && (at - memory.anchor).dot(normal) > 0) {  // the traction would be tensile
      memory.touching = false;
    } else if (!was_touching && distance < 0) {
      const double before = surface_->distance(inSpace(memory.last));
      const double share = before > 0 ? before / (before - distance) : 0;
      const Vector met = memory.last + share * (at - memory.last);
      const double off = gap(met, normal, curvature);
      memory.anchor = met - off * normal;
      memory.touching = true;
    }
    return was_touching != memory.touching;
  }
  if (config_.friction == 0) return false;
  if (was_touching) {
    const Vector slip = (at - memory.anchor) - memory.normal * memory.normal.dot(at - memory.anchor);
    const double bound = config_.friction * memory.traction, length = slip.norm();
    const double elastic = bound > 0 ? bound / slipStiffness(memory) : 0;
    memory.anchor = at - (length > elastic ? Vector(elastic / length * slip) : slip);
  } else {
    memory.anchor = at;
  }
  memory.touching = distance < 0;
  memory.traction = pressing(std::max(0.0, -distance)).traction;
  memory.normal = normal;
  return was_touching || memory.touching;
}

template <int Dim>
bool RigidContact<Dim>::beginStep(double /*duration*/) {
  for (Facet& facet : facets_) {
    for (Point& point : facet.points) point.memory = point.accepted;
  }
  return false;
}

template <int Dim>
bool RigidContact<Dim>::settle(const Eigen::VectorXd& state) {
  bool changed = false;
  deepest_ = 0;
  for (Facet& facet : facets_) {
    for (Point& point : facet.points) {
      const Vector at = relative(facet, point, state);
      deepest_ = std::max(deepest_, -surface_->distance(inSpace(at)));
      changed = settle(point.memory, at) || changed;
    }
  }
  return changed;
}

template <int Dim>
void RigidContact<Dim>::accept(const Eigen::VectorXd& state) {
  for (Facet& facet : facets_) {
    for (Point& point : facet.points) {
      Memory& memory = point.memory;
      memory.last = relative(facet, point, state);
      if (config_.adhesion > 0) {
        const double distance = surface_->distance(inSpace(memory.last));
        memory.bonded = memory.touching || distance < 0 || (memory.bonded && distance < kFree * config_.adhesion_range);
      }
      point.accepted = memory;
    }
  }
}

template <int Dim>
void RigidContact<Dim>::reset() {
  deepest_ = 0;
  for (Facet& facet : facets_) {
    for (Point& point : facet.points) {
      point.accepted = Memory();
      point.accepted.last = point.undeformed;
      point.memory = point.accepted;
    }
  }
}

template <int Dim>
typename RigidContact<Dim>::Ring RigidContact<Dim>::ring(const Eigen::VectorXd& state) const {
  Ring ring;
  double weight = 0, square = 0;
  Local local;
  for (const Facet& facet : facets_) {
    for (const Point& point : facet.points) {
      const Vector at = relative(facet, point, state);
      if (!contribution(point, at, local)) continue;
      const double pressed = local.gradient.norm(), r = inSpace(at).template head<2>().norm();
      ring.force -= local.gradient[Dim - 1];
      weight += pressed;
      ring.radius += pressed * r;
      square += pressed * r * r;
    }
  }
  if (!(weight > 0)) return Ring();
  ring.radius /= weight;
  ring.spread = std::sqrt(std::max(square / weight - ring.radius * ring.radius, 0.0));
  return ring;
}

template <int Dim>
double RigidContact<Dim>::clearance(const Eigen::VectorXd& state, const Eigen::Vector3d& translation) const {
  const Vector away = fromSpace<Dim>(translation);
  double smallest = std::numeric_limits<double>::infinity();
  for (const Facet& facet : facets_) {
    for (const Point& point : facet.points) {
      Vector at = relative(facet, point, state);
      for (std::size_t i = 0; i < moving_.size(); ++i)
        at[moving_[i]] += state[facet.entries[Dim * facet.nodes + i]] - away[moving_[i]];
      smallest = std::min(smallest, surface_->distance(inSpace(at)));
    }
  }
  return smallest;
}

template <int Dim>
int RigidContact<Dim>::touchingPoints() const {
  int count = 0;
  for (const Facet& facet : facets_) {
    for (const Point& point : facet.points)
      count += surface_->distance(inSpace(point.memory.last)) < 0 || point.memory.touching;
  }
  return count;
}

template class RigidContact<2>;
template class RigidContact<3>;

}  // namespace microinjection
