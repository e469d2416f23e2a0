#include "cell/mesh/mesh_config.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

#include "base/config_errors.h"

namespace microinjection {
namespace {

/// "key[index].field"
std::string keyOf(const std::string& key, std::size_t index, const std::string& field = "") {
  return key + '[' + std::to_string(index) + ']' + (field.empty() ? "" : "." + field);
}

/// Requires radii of concentric layers, outermost first: positive, descending, and no layer (nor
/// the innermost ball) thinner than `thinnest` times the first. Returns false when they are not;
/// the caller must not use them then.
bool requireLayerRadii(const std::vector<double>& radii, double thinnest, ConfigErrors& errors) {
  if (radii.empty()) {
    errors.add("radii is empty: must be at least the radius of the cell");
    return false;
  }
  const std::size_t errors_before = errors.messages().size();
  std::ostringstream thickness;
  thickness << "positive, and each layer at least " << thinnest << " of the first radius thick";
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double next = i + 1 < radii.size() ? radii[i + 1] : 0;
    const bool good = Range::positive().contains(radii[i]) && !(radii[i] - next < thinnest * radii[0]);
    errors.require(good, keyOf("radii", i), radii[i], "", "descending, " + thickness.str());
  }
  return errors.messages().size() == errors_before;
}

/// The thinnest layer over the radius of the cell. Thinner ones need millions of elements.
constexpr double kThinnestShell = 1.0 / 100;

/// The smallest element over the radius of the cell: OpenCASCADE's tolerance is 1e-7.
constexpr double kSmallestTetrahedron = 1e-5;

/// Largest stretch. Beyond it gmsh would mesh a nearly flat disc.
constexpr double kMostStretched = 4;

/// Largest distance of circles from the axis, over the cell's radius. Further out the surface is
/// too steep.
constexpr double kSteep = 0.95;

/// The narrowest gap between two circles, over the radius of the smaller one.
constexpr double kNarrowestGap = 0.05;

bool touch(const CellMeshConfig::Circle& one, const CellMeshConfig::Circle& other) {
  if (one.side != other.side) return false;
  const double apart = (one.centre - other.centre).norm();
  const double gap = std::max(apart - one.radius - other.radius, std::abs(one.radius - other.radius) - apart);
  return gap < kNarrowestGap * std::min(one.radius, other.radius);
}

bool isSide(double side) { return side == 1 || side == -1; }

/// @pre the radii are valid
void checkRefinement(ConfigErrors& errors, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Refinement& refinement = config.refinements[i];
  const auto key = [i](const std::string& field) { return keyOf("refinements", i, field); };
  const double cell = config.radii.front(), from_axis = refinement.centre.norm();
  const bool ball = refinement.shape == CellMeshConfig::Shape::kBall;
  errors.require(from_axis < cell, key("centre"), from_axis, "", "nearer to the z axis than the cell's radius");
  if (ball) {
    errors.require(std::isfinite(refinement.radius) && refinement.radius >= 0, key("radius"), refinement.radius, "",
                   "0 or positive");
  } else {
    errors.require(Range::positive().contains(refinement.radius) && from_axis + refinement.radius < cell, key("radius"),
                   refinement.radius, "",
                   "positive, and with the centre's distance from the z axis below the cell's radius");
  }
  errors.require(isSide(refinement.side), key("side"), refinement.side, "", "+1 or -1");
  errors.require(std::isfinite(refinement.size) && refinement.size >= kSmallestTetrahedron * cell, key("size"),
                 refinement.size, "", "at least 1e-5 of the cell's radius");
}

/// @pre the radii are valid
void checkImprint(ConfigErrors& errors, const CellMeshConfig& config, std::size_t i) {
  const CellMeshConfig::Circle& circle = config.imprints[i];
  const double reach = circle.centre.norm() + circle.radius;
  errors.require(Range::positive().contains(circle.radius) &&
                     circle.radius > 10 * kSmallestTetrahedron * config.radii.front() &&
                     reach < kSteep * config.radii.front(),
                 keyOf("imprints", i, "radius"), circle.radius, "",
                 "above 1e-4 and with the centre's distance from the z axis below 0.95 of the cell's radius");
  errors.require(isSide(circle.side), keyOf("imprints", i, "side"), circle.side, "", "+1 or -1");
  for (std::size_t j = 0; j < i; ++j) {
    errors.require(!touch(circle, config.imprints[j]), keyOf("imprints", i, "radius"), circle.radius, "",
                   "such that it keeps 0.05 of the smaller radius away from " + keyOf("imprints", j));
  }
}

/// Thickness of the thinnest layer and size of the smallest element, over the radius of the cell.
constexpr double kThinnestRing = 1.0 / 1000;
constexpr double kSmallestTriangle = 1e-6;

/// Points of an arc within this angle are the same point, rad.
constexpr double kSamePoint = 1e-9;

void checkPoint(ConfigErrors& errors, const std::string& key, double r, double side, double radius) {
  errors.require(r >= 0 && r <= radius, key + ".r", r, "", "in [0, the cell's radius]");
  errors.require(isSide(side), key + ".side", side, "", "+1 or -1");
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

void CellMeshConfig::validate() const {
  ConfigErrors errors("cell mesh");
  errors.require(Range::positive(), "size", size);
  errors.require(Range{0, 1, true, false}, "growth", growth);
  errors.require(Range::closed(1, kMostStretched), "stretch", stretch);
  if (requireLayerRadii(radii, kThinnestShell, errors)) {
    errors.require(!(size < kSmallestTetrahedron * radii.front()), "size", size, "",
                   "at least 1e-5 of the cell's radius");
    for (std::size_t i = 0; i < refinements.size(); ++i) checkRefinement(errors, *this, i);
    for (std::size_t i = 0; i < imprints.size(); ++i) checkImprint(errors, *this, i);
  }
  errors.throwAny();
}

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
