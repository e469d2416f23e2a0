#include "rig/manipulator/homing_plan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "rig/manipulator/collision_guard.h"
#include "rig/manipulator/manipulator_geometry.h"

namespace microinjection {
namespace {

constexpr double kSpacing = 1e-3;  // m, of the places that are tried
constexpr double kFinest = 25e-6;  // m, near 0, where the needle works beside small obstacles

using Places = std::array<std::vector<double>, 3>;  // m, where each joint may be

std::vector<double> placesOf(const ManipulatorGeometry::Axis& axis) {
  const int steps = std::max(1, static_cast<int>(std::ceil((axis.upper - axis.lower) / kSpacing)));
  std::vector<double> places;
  for (int i = 0; i <= steps; ++i) places.push_back(axis.lower + (axis.upper - axis.lower) * i / steps);
  places.push_back(0);
  for (double away = kFinest; away < kSpacing; away *= 2) {
    places.push_back(away);
    places.push_back(-away);
  }
  const auto outside = [&axis](double place) { return place < axis.lower || place > axis.upper; };
  places.erase(std::remove_if(places.begin(), places.end(), outside), places.end());
  return places;
}

/// Why the joint cannot go to its end from somewhere; a place within an obstacle is none where it can be.
std::string blocksAxis(const CollisionGuard& guard, const Places& places, int joint, double end) {
  for (const double x : places[0]) {
    for (const double y : places[1]) {
      for (const double z : places[2]) {
        const Eigen::Vector3d from(x, y, z);
        if (!guard.blocks(from).empty()) continue;
        Eigen::Vector3d to = from;
        to[joint] = end;
        if (std::string why = guard.blocksPath(from, to); !why.empty()) return why;
      }
    }
  }
  return "";
}

std::string blocksOrder(const ManipulatorGeometry& geometry, const CollisionGuard& guard, const Eigen::Vector3d& ends,
                        const std::array<int, 3>& order) {
  Places places;
  for (int i = 0; i < 3; ++i) places[i] = placesOf(geometry.axes[i]);
  for (const int joint : order) {
    const std::string why = blocksAxis(guard, places, joint, ends[joint]);
    if (!why.empty()) return geometry.axes[joint].joint + " on its way to its reference position: " + why;
    places[joint] = {ends[joint]};
  }
  return "";
}

}  // namespace

HomingPlan planHoming(const ManipulatorGeometry& geometry, const CollisionGuard& guard, const Eigen::Vector3d& ends) {
  HomingPlan plan;
  plan.refusal = geometry.outsideTravel(ends);
  if (plan.refusal.empty()) plan.refusal = guard.blocks(ends);
  if (!plan.refusal.empty()) {
    plan.refusal = "it would end at the reference positions, where " + plan.refusal;
    return plan;
  }
  // Up first, as a person would: most rigs need no second try.
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::abs(geometry.directions(2, a)) > std::abs(geometry.directions(2, b)); });
  const std::array<int, 3> first = order;
  std::string refusal;
  std::array<int, 3> rank{0, 1, 2};  // every order of `first`
  do {
    for (int i = 0; i < 3; ++i) order[i] = first[rank[i]];
    const std::string why = blocksOrder(geometry, guard, ends, order);
    if (why.empty()) return {order, ""};
    if (refusal.empty()) refusal = why;
  } while (std::next_permutation(rank.begin(), rank.end()));
  return {first, "no order of the axes keeps clear of the obstacles; " + refusal};
}

}  // namespace microinjection
