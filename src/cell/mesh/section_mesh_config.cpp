#include "cell/mesh/section_mesh_config.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "cell/mesh/layer_radii.h"

namespace microinjection {
namespace {

/// Thickness of the thinnest layer and size of the smallest element, over the radius of the cell.
constexpr double kThinnestRing = 1.0 / 1000;
constexpr double kSmallestTriangle = 1e-6;

/// Points of an arc within this angle are the same point, rad.
constexpr double kSamePoint = 1e-9;

void checkPoint(ConfigErrors& errors, const std::string& key, double r, double side, double radius) {
  errors.require(r >= 0 && r <= radius, key + ".r", r, "", "in [0, the cell's radius]");
  errors.require(side == 1 || side == -1, key + ".side", side, "", "+1 or -1");
}

/// @pre the points are valid
void checkGaps(ConfigErrors& errors, const SectionMeshConfig& config) {
  const std::vector<Eigen::Vector2d> points = namedPoints(config, 0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double apart = (points[i] - points[i - 1]).norm();
    errors.require(apart >= kSmallestTriangle * config.radii.front(),
                   "distance of neighbouring points on the outer arc", apart, "",
                   "0 or at least 1e-6 of the cell's radius, also from the axis");
  }
}

}  // namespace

Eigen::Vector2d pointOnArc(double r, double side, double radius) {
  return {r, side * std::sqrt(std::max(0.0, (radius - r) * (radius + r)))};
}

/// The ends of a layer's arc and the named points on it, m, from top to bottom.
std::vector<Eigen::Vector2d> namedPoints(const SectionMeshConfig& config, std::size_t layer) {
  const double radius = config.radii[layer];
  std::map<double, Eigen::Vector2d> points;  // by the angle from the top
  const auto add = [&](const Eigen::Vector2d& point) {
    const double angle = std::atan2(point.x(), point.y());
    const auto next = points.lower_bound(angle - kSamePoint);
    if (next == points.end() || next->first > angle + kSamePoint) points[angle] = point;
  };
  add({0, radius});
  add({0, -radius});
  if (layer == 0) {
    for (const auto& point : config.vertices) add(pointOnArc(point.r, point.side, radius));
    for (const auto& refinement : config.refinements) add(pointOnArc(refinement.r, refinement.side, radius));
  }
  std::vector<Eigen::Vector2d> sorted;
  sorted.reserve(points.size());
  for (const auto& point : points) sorted.push_back(point.second);
  return sorted;
}

void SectionMeshConfig::validate() const {
  ConfigErrors errors("section mesh");
  errors.require(Range::positive(), "size", size);
  errors.require(Range{0, 1, true, false}, "growth", growth);
  if (requireLayerRadii(radii, kThinnestRing, errors)) {
    const double cell = radii.front();
    const auto checkSize = [&](const std::string& key, double value) {
      errors.require(std::isfinite(value) && value >= kSmallestTriangle * cell, key, value, "",
                     "at least 1e-6 of the cell's radius");
    };
    if (Range::positive().contains(size)) checkSize("size", size);
    for (std::size_t i = 0; i < refinements.size(); ++i) {
      const Refinement& refinement = refinements[i];
      checkPoint(errors, keyOf("refinements", i), refinement.r, refinement.side, cell);
      errors.require(std::isfinite(refinement.reach) && refinement.reach >= 0, keyOf("refinements", i, "reach"),
                     refinement.reach, "", "0 or positive");
      checkSize(keyOf("refinements", i, "size"), refinement.size);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      checkPoint(errors, keyOf("vertices", i), vertices[i].r, vertices[i].side, cell);
    }
    if (errors.good()) checkGaps(errors, *this);
  }
  errors.throwAny();
}

}  // namespace microinjection
