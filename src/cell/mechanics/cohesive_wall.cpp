#include "cell/mechanics/cohesive_wall.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cell/mechanics/reference_element.h"

namespace microinjection {
namespace {

constexpr double kOnWall = 1e-6;  ///< of the hole's radius

double openingOf(const Eigen::VectorXd& shape, const std::vector<int>& entries, const Eigen::VectorXd& state) {
  double opening = 0;
  for (std::size_t a = 0; a < entries.size(); ++a) opening += shape[a] * state[entries[a]];
  return opening;
}

}  // namespace

CohesiveWall::CohesiveWall(const LayeredBody<2>& body, const CohesiveWallConfig& config) : config_(config) {
  if (!(config.radius > 0 && config.toughness > 0 && config.opening > 0 && config.closed >= 0))
    throw std::invalid_argument("a cohesive wall needs a positive radius, toughness and opening");
  const bool quadratic = isQuadratic(body.kind());
  const auto& nodes = body.mesh().nodes;
  for (const auto& side : body.mesh().facets) {
    const bool on_wall = std::all_of(side.nodes.begin(), side.nodes.end(),
                                     [&](int node) { return std::abs(nodes[node].x() / config.radius - 1) < kOnWall; });
    if (!on_wall) continue;
    Facet facet;
    for (int a = 0; a < (quadratic ? 3 : 2); ++a) facet.entries.push_back(2 * side.nodes[a]);
    const double length = (nodes[side.nodes[1]] - nodes[side.nodes[0]]).norm();
    double total = 0;
    for (const auto& at : referenceFacet<2>().points) total += at.weight;
    for (const auto& at : referenceFacet<2>().points) {
      Point point;
      point.shape = quadratic ? Eigen::VectorXd(at.shape) : Eigen::VectorXd(at.barycentric);
      point.weight = 2 * M_PI * config.radius * length * at.weight / total;
      facet.points.push_back(std::move(point));
    }
    facets_.push_back(std::move(facet));
  }
  if (facets_.empty()) throw std::invalid_argument("the body has no wall at this radius");
}

double CohesiveWall::strength(const CohesiveWallConfig& config) { return config.toughness / (M_E * config.opening); }

bool CohesiveWall::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Facet& facet = facets_[index];
  const Eigen::Index size = static_cast<Eigen::Index>(facet.entries.size());
  const double d = config_.opening, unit = config_.toughness / (d * d);
  result.zero = false;
  result.energy = 0;
  if (order != Order::kEnergy) result.gradient.setZero(size);
  if (order == Order::kHessian) result.hessian.setZero(size, size);
  for (const Point& point : facet.points) {
    const double o = openingOf(point.shape, facet.entries, state);
    const double reached = std::max(point.largest, o), decay = std::exp(-reached / d);
    double energy, traction, stiffness;
    if (o < 0) {
      traction = config_.closed * o;
      stiffness = config_.closed;
      energy = 0.5 * traction * o;
    } else {
      traction = unit * o * decay;
      stiffness = unit * decay * (o < reached ? 1 : 1 - o / d);
      energy = 0.5 * unit * decay * o * o;
    }
    // What it has cost to come to the largest opening, of which only the triangle below the traction is given back.
    energy += config_.toughness * (1 - (1 + reached / d) * decay) - 0.5 * unit * decay * reached * reached;
    result.energy += point.weight * energy;
    if (order != Order::kEnergy) result.gradient += point.weight * traction * point.shape;
    if (order == Order::kHessian) result.hessian += point.weight * stiffness * point.shape * point.shape.transpose();
  }
  return std::isfinite(result.energy);
}

void CohesiveWall::accept(const Eigen::VectorXd& state) {
  for (Facet& facet : facets_) {
    for (Point& point : facet.points)
      point.largest = std::max(point.largest, openingOf(point.shape, facet.entries, state));
  }
}

void CohesiveWall::reset() {
  for (Facet& facet : facets_) {
    for (Point& point : facet.points) point.largest = 0;
  }
}

}  // namespace microinjection
