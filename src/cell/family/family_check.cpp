#include "cell/family/family_check.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace microinjection {
namespace {

constexpr int kMotions = 5, kPoints = 2;
constexpr double kLargestAngle = 56 * M_PI / 180;
constexpr double kDeepest = 0.3, kSideways = 0.08;  ///< over the diameter
constexpr double kShallowest = 0.15;                ///< over the depth of the range
constexpr double kSteepness = 0.5;                  ///< least depth over lateral motion
constexpr double kOverlap = 0.02;                   ///< least overlap of tip and cell, over the cell's radius

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

/// Overlap of a round tip with the cell at rest, at the end of a motion, in radii of the cell.
double overlap(double tip_radius, double angle, const Eigen::Vector3d& displacement) {
  const double reach = 1 + tip_radius;
  return reach - (reach * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)) + displacement).norm();
}

Eigen::Vector3d evaluate(const SurrogateData& cell, const TrainingSample& at) {
  ForceField::Local local;
  cell.field.makeLocal(at.angle, local);
  Eigen::Matrix3d jacobian;
  return local.evaluate(at.displacement, jacobian);
}

}  // namespace

std::vector<Eigen::VectorXd> drawMembers(const Family& family, int count, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::vector<Eigen::VectorXd> members;
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd coordinates(family.dimension());
    // A thousandth is exact enough, and short as text.
    for (double& x : coordinates) x = std::round(1000 * uniform(random, -1, 1)) / 1000;
    members.push_back(coordinates);
  }
  return members;
}

Preparation drawMotions(const Family& family, const Eigen::VectorXd& coordinates, int seed) {
  const Scene member = family.member(coordinates);
  Preparation motions = planMember(family, member);
  const PreparationRange& range = motions.range;
  motions.rays.clear();
  std::mt19937 random(static_cast<unsigned>(seed));
  const double deepest = std::min(2 * kDeepest, range.depth), sideways = std::min(2 * kSideways, range.lateral);
  for (int count = 0; count < kMotions;) {
    const double angle = uniform(random, 0, kLargestAngle), depth = uniform(random, kShallowest, 1) * deepest;
    const double side = sideways * std::sqrt(uniform(random, 0, 1)), turn = uniform(random, 0, M_PI);
    const bool in_plane = count > 0;
    const double away = in_plane ? (turn < M_PI / 2 ? 1 : -1) : std::cos(turn);
    const Eigen::Vector3d end(side * away, in_plane ? 0 : side * std::sin(turn), -depth);
    if (depth < kSteepness * side || overlap(member.needle.tip.radius, angle, end) < kOverlap) continue;
    ++count;
    for (const double level : {kFineLevel, kCoarseLevel}) motions.rays.push_back({angle, end, kPoints, level});
  }
  return motions;
}

std::vector<CheckedPlace> compareMember(const FamilyData& data, const Eigen::VectorXd& coordinates,
                                        const Preparation& motions, const std::vector<TrainingResult>& results) {
  const SurrogateData cell = data.cell(coordinates);
  std::vector<CheckedPlace> places;
  double largest = 0;
  for (std::size_t i = 0; i + 1 < motions.rays.size(); i += 2) {
    const TrainingResult &fine = results[i], &coarse = results[i + 1];
    for (std::size_t k = 0; k < std::min(fine.samples.size(), coarse.samples.size()); ++k) {
      const TrainingSample& truth = fine.samples[k];
      const Eigen::Vector3d& u = truth.displacement;
      if (-u.z() > cell.range.depth || u.head<2>().norm() > cell.range.lateral) continue;
      CheckedPlace place;
      place.angle = truth.angle;
      place.depth = -0.5 * u.z();
      place.lateral = 0.5 * u.head<2>().norm();
      place.force_share = truth.force.norm();
      place.force_error = (evaluate(cell, truth) - truth.force).norm() / truth.force.norm();
      Eigen::VectorXd rest, moved;
      cell.surface.evaluate(truth.angle, u, rest, moved);
      const Eigen::VectorXd difference = moved - coarse.samples[k].surface.cast<double>();
      place.surface_error = 0.5 * difference.norm() / std::sqrt(static_cast<double>(difference.size()) / 3);
      largest = std::max(largest, place.force_share);
      places.push_back(place);
    }
  }
  for (CheckedPlace& place : places) place.force_share /= largest;
  return places;
}

}  // namespace microinjection
