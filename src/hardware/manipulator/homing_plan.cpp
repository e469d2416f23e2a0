#include "hardware/manipulator/homing_plan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hardware/manipulator/collision_guard.h"
#include "hardware/manipulator/manipulator_geometry.h"

namespace microinjection {
namespace {

constexpr double kSpacing = 1e-3;  // m, between the start positions that are checked
constexpr double kFinest = 25e-6;  // m, near 0, where the needle works beside small obstacles

using Positions = std::array<std::vector<double>, 3>;  // m, possible start positions of each joint

std::vector<double> positionsOf(const ManipulatorGeometry::Axis& axis) {
  const int steps = std::max(1, static_cast<int>(std::ceil((axis.upper - axis.lower) / kSpacing)));
  std::vector<double> positions;
  for (int i = 0; i <= steps; ++i) positions.push_back(axis.lower + (axis.upper - axis.lower) * i / steps);
  positions.push_back(0);
  for (double away = kFinest; away < kSpacing; away *= 2) {
    positions.push_back(away);
    positions.push_back(-away);
  }
  const auto outside = [&axis](double position) { return position < axis.lower || position > axis.upper; };
  positions.erase(std::remove_if(positions.begin(), positions.end(), outside), positions.end());
  return positions;
}

/// Returns the reason why the joint cannot reach its end from some start position, else an empty
/// text. Start positions inside an obstacle are impossible and skipped.
std::string blocksAxis(const CollisionGuard& guard, const Positions& positions, int joint, double end) {
  for (const double x : positions[0]) {
    for (const double y : positions[1]) {
      for (const double z : positions[2]) {
        const Eigen::Vector3d from(x, y, z);
        if (!guard.blocks(from).empty()) continue;
        Eigen::Vector3d to = from;
        to[joint] = end;
        if (std::string reason = guard.blocksPath(from, to); !reason.empty()) return reason;
      }
    }
  }
  return "";
}

std::string blocksOrder(const ManipulatorGeometry& geometry, const CollisionGuard& guard, const Eigen::Vector3d& ends,
                        const std::array<int, 3>& order) {
  Positions positions;
  for (int i = 0; i < 3; ++i) positions[i] = positionsOf(geometry.axes[i]);
  for (const int joint : order) {
    const std::string reason = blocksAxis(guard, positions, joint, ends[joint]);
    if (!reason.empty()) return geometry.axes[joint].joint + " on its path to its reference position: " + reason;
    positions[joint] = {ends[joint]};
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
  // Tries the most vertical axis first: on most rigs this succeeds at once.
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::abs(geometry.directions(2, a)) > std::abs(geometry.directions(2, b)); });
  const std::array<int, 3> first = order;
  std::string refusal;
  std::array<int, 3> rank{0, 1, 2};  // runs through all permutations of `first`
  do {
    for (int i = 0; i < 3; ++i) order[i] = first[rank[i]];
    const std::string reason = blocksOrder(geometry, guard, ends, order);
    if (reason.empty()) return {order, ""};
    if (refusal.empty()) refusal = reason;
  } while (std::next_permutation(rank.begin(), rank.end()));
  return {first, "no order of the axes keeps clear of the obstacles; " + refusal};
}

}  // namespace microinjection
