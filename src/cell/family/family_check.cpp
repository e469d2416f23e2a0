#include "cell/family/family_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "cell/surrogate/mesh_correction.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr int kMotions = 5, kPointsOfMotion = 2;
constexpr double kLargestAngle = 56 * M_PI / 180;
constexpr double kDeepest = 0.3, kSideways = 0.08;  ///< over the diameter
constexpr double kShallowest = 0.15;                ///< over the depth of the range
constexpr double kLeastSlope = 0.5;                 ///< least depth over lateral motion
/// Change from the fine mesh to the limit, over that from the coarse to the fine one. `./dev bench mesh_limit` has 0.2
/// at small depths and on the axis, and 0.5 deep beside it.
constexpr double kExtrapolation = 0.5;
/// A path below this length, over the tip's radius, touches a few elements of the fine mesh: its force is up to 6 %
/// off. Half a level finer it is 0.2 % from that of two levels finer (`prepare --check`, member 1 of seed 1).
constexpr double kShallow = 0.8;
constexpr double kShallowLevel = 0.5;
constexpr int kNodeStride = 23;    ///< of the grid's nodes that references have
constexpr double kOverlap = 0.02;  ///< least overlap of tip and cell, over the cell's radius

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

/// Overlap of a round tip with the cell at rest, at the end of a motion, in radii of the cell.
double overlap(double tip_radius, double angle, const Eigen::Vector3d& displacement) {
  const double reach = 1 + tip_radius;
  return reach - (reach * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)) + displacement).norm();
}

Eigen::Vector3d evaluate(const SurrogateData& cell, double angle, const Eigen::Vector3d& displacement) {
  ForceField::Local local;
  cell.field.makeLocal(angle, local);
  Eigen::Matrix3d jacobian;
  return local.evaluate(displacement, jacobian);
}

Eigen::VectorXf atReferenceNodes(const Eigen::VectorXf& surface) {
  const std::vector<int> nodes = referenceNodes();
  Eigen::VectorXf result(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    result.segment<3>(3 * static_cast<Eigen::Index>(i)) = surface.segment<3>(3 * nodes[i]);
  }
  return result;
}

/// Nothing beyond the cell's range. `force_share` is the force itself.
std::optional<CheckedPlace> compare(const SurrogateData& cell, const ReferencePlace& truth) {
  const Eigen::Vector3d& u = truth.displacement;
  if (-u.z() > cell.range.depth || u.head<2>().norm() > cell.range.lateral) return std::nullopt;
  CheckedPlace place;
  place.member = truth.member;
  place.angle = truth.angle;
  place.depth = -0.5 * u.z();
  place.lateral = 0.5 * u.head<2>().norm();
  place.force_share = truth.force.norm();
  place.force_error = (evaluate(cell, truth.angle, u) - truth.force).norm() / truth.force.norm();
  Eigen::VectorXd rest, moved;
  cell.surface.evaluate(truth.angle, u, rest, moved);
  const Eigen::VectorXf difference = atReferenceNodes(moved.cast<float>()) - truth.surface;
  place.surface_error = 0.5 * difference.norm() / std::sqrt(static_cast<double>(difference.size()) / 3);
  return place;
}

/// A path for each point of the fine paths in the plane of symmetry that is nearer than `length`. Beside the plane the
/// mesh is a whole one, and too expensive.
std::vector<TrainingRay> shallowMotions(const std::vector<TrainingRay>& rays, double length) {
  std::vector<TrainingRay> result;
  for (const TrainingRay& ray : rays) {
    for (int i = 0; i < ray.points && ray.level == kFineLevel && ray.target.y() == 0; ++i) {
      if (ray.at(i).norm() < length) result.push_back({ray.angle, ray.at(i), 1, kShallowLevel});
    }
  }
  return result;
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

SurrogatePlan drawMotions(const Family& family, const Eigen::VectorXd& coordinates, int seed) {
  const Scene member = family.member(coordinates);
  SurrogatePlan motions = planMember(family, member);
  const SurrogateRange& range = motions.range;
  motions.rays.clear();
  std::mt19937 random(static_cast<unsigned>(seed));
  const double deepest = std::min(2 * kDeepest, range.depth), sideways = std::min(2 * kSideways, range.lateral);
  for (int count = 0; count < kMotions;) {
    const double angle = uniform(random, 0, kLargestAngle), depth = uniform(random, kShallowest, 1) * deepest;
    const double side = sideways * std::sqrt(uniform(random, 0, 1)), turn = uniform(random, 0, M_PI);
    const bool in_plane = count > 0 || seed % 2 == 0;
    const double away = in_plane ? (turn < M_PI / 2 ? 1 : -1) : std::cos(turn);
    const Eigen::Vector3d end(side * away, in_plane ? 0 : side * std::sin(turn), -depth);
    if (depth < kLeastSlope * side || overlap(member.needle.tip.radius, angle, end) < kOverlap) continue;
    ++count;
    for (const double level : {kFineLevel, kCoarseLevel}) motions.rays.push_back({angle, end, kPointsOfMotion, level});
  }
  const std::vector<TrainingRay> shallow = shallowMotions(motions.rays, kShallow * member.needle.tip.radius);
  motions.rays.insert(motions.rays.end(), shallow.begin(), shallow.end());
  return motions;
}

std::vector<int> referenceNodes() {
  std::vector<int> nodes;
  for (int node = 0; node < SurfaceGrid::standard().nodeCount(); node += kNodeStride) nodes.push_back(node);
  return nodes;
}

std::vector<ReferencePlace> referencePlaces(int member, const Eigen::VectorXd& coordinates,
                                            const SurrogatePlan& motions, const std::vector<TrainingResult>& results) {
  std::vector<MeshCorrection::Pair> pairs;
  std::vector<const TrainingSample*> shallow;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (motions.rays[i].level == kFineLevel && i + 1 < results.size())
      pairs.push_back({&results[i + 1].samples, &results[i].samples});
    if (motions.rays[i].level == kShallowLevel && !results[i].samples.empty())
      shallow.push_back(&results[i].samples[0]);
  }
  const MeshCorrection correction(motions.scales, pairs);
  std::vector<ReferencePlace> places;
  for (const auto& [coarse, fine] : pairs) {
    for (std::size_t k = 0; k < std::min(fine->size(), coarse->size()); ++k) {
      const TrainingSample& truth = (*fine)[k];
      const double to_fine = correction.factor(truth.angle, truth.displacement);
      const auto finer = std::find_if(shallow.begin(), shallow.end(), [&](const TrainingSample* sample) {
        return sample->angle == truth.angle && sample->displacement == truth.displacement;
      });
      const Eigen::Vector3d limit = truth.force * std::pow(to_fine, kExtrapolation);
      places.push_back({member, coordinates, truth.angle, truth.displacement,
                        finer == shallow.end() ? limit : (*finer)->force, atReferenceNodes((*coarse)[k].surface)});
    }
  }
  return places;
}

std::vector<CheckedPlace> comparePlaces(const FamilyData& data, const std::vector<ReferencePlace>& places) {
  std::vector<CheckedPlace> result;
  std::vector<CheckedPlace> own;  // of one member
  SurrogateData cell;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || places[i].member != places[i - 1].member) cell = data.cell(places[i].coordinates);
    if (const auto place = compare(cell, places[i])) own.push_back(*place);
    if (i + 1 < places.size() && places[i + 1].member == places[i].member) continue;
    double largest = 0;
    for (const CheckedPlace& place : own) largest = std::max(largest, place.force_share);
    for (CheckedPlace& place : own) {
      place.force_share /= largest;
      result.push_back(place);
    }
    own.clear();
  }
  return result;
}

}  // namespace microinjection
