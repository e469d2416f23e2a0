#include "cell/family/family_places.h"

#include <algorithm>

#include "cell/surrogate/surface_shape.h"

namespace microinjection {
namespace {

constexpr double kShares[] = {0.06, 0.25, 0.55, 1};  ///< of a path's length
constexpr int kDeep = 6;                             ///< on the axis, below the depth of the range elsewhere

}  // namespace

SurrogateRange familyRange(double angle, double depth) {
  constexpr double kAxisDepth = 2.23606797749979, kLateral = 0.25;
  return {angle, depth, kAxisDepth * depth, kLateral * depth};
}

std::vector<ContactPlace> surfacePlaces(const SurrogateRange& range) {
  std::vector<ContactPlace> places;
  std::vector<double> angles;
  for (const TrainingRay& ray : SurrogatePlan::paths(range, PathSet::kAll)) {
    if (ray.level != kCoarseLevel) continue;
    for (const double share : kShares) places.push_back({ray.angle, share * ray.target, share});
    if (std::find(angles.begin(), angles.end(), ray.angle) == angles.end()) angles.push_back(ray.angle);
  }
  for (int i = 1; i <= kDeep; ++i) {
    const double depth = range.depth + (range.axis_depth - range.depth) * i / kDeep;
    places.push_back({0, -depth * Eigen::Vector3d::UnitZ(), 1});
  }
  for (const double angle : angles) places.push_back({angle, Eigen::Vector3d::Zero(), 0});
  return places;
}

Eigen::MatrixXd surfaceCentres() {
  const SurrogateRange unit = familyRange(1, 1);
  const std::vector<ContactPlace> places = surfacePlaces(unit);
  Eigen::MatrixXd centres(4, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    centres.col(static_cast<Eigen::Index>(i)) = contactVariables(unit, places[i].angle, places[i].displacement);
  }
  return centres;
}

std::vector<ContactPlace> forcePlaces(const SurrogatePlan& plan) {
  std::vector<ContactPlace> places;
  for (const TrainingRay& ray : plan.rays) {
    if (ray.level != kCoarseLevel) continue;
    for (const double share : kShares) places.push_back({ray.angle, share * ray.target, share});
  }
  return places;
}

}  // namespace microinjection
