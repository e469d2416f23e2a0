#include "cell/family/family_member.h"

#include <cmath>

#include "cell/family/axis_force.h"
#include "cell/family/family_places.h"

namespace microinjection {
namespace {

constexpr double kSamePlace = 1e-9;  ///< squared distance of coordinates

/// All of a member but its place and its paths.
FamilyMember ofCell(const SurrogateData& cell, const SurrogatePlan& plan) {
  FamilyMember member;
  member.reached = {cell.range.depth / plan.range.depth, cell.range.axis_depth / plan.range.axis_depth};
  member.scale = axisForce(cell.field, plan);
  member.energy = cell.energy.coefficients() / member.scale;
  member.field = cell.field.coefficients() / member.scale;
  member.median_error = cell.median_error;
  member.common_error = cell.common_error;
  return member;
}

}  // namespace

Reached reachedAt(const Eigen::VectorXd& coordinates, const std::vector<const FamilyMember*>& solved) {
  Reached sum{0, 0};
  double weights = 0;
  for (const FamilyMember* member : solved) {
    const double square = (member->coordinates - coordinates).squaredNorm();
    const double weight = 1 / std::pow(square + kSamePlace, 2);
    sum.share += weight * member->reached.share;
    sum.axis_share += weight * member->reached.axis_share;
    weights += weight;
  }
  return {sum.share / weights, sum.axis_share / weights};
}

AxisCurve curveRatio(const AxisCurve& other, const FamilyMember& member, const ForceField& field,
                     const EnergyScales& scales) {
  return axisRatio(other, axisCurve(field, scales), member.reached.axis_share);
}

SurrogatePlan planMember(const Family& family, const Scene& member) {
  return SurrogatePlan::plan(member, family.range(member), PathSet::kFew);
}

FamilyMember fitMember(const Family& family, const Eigen::VectorXd& coordinates,
                       const std::vector<TrainingResult>& results, Eigen::MatrixXf& displacements) {
  const Scene scene = family.member(coordinates);
  const SurrogatePlan plan = planMember(family, scene);
  const SurrogateData cell = SurrogateData::fit(scene, plan, results);
  FamilyMember member = ofCell(cell, plan);
  member.coordinates = coordinates;
  member.paths = pathForces(results);
  const std::vector<ContactPlace> places = surfacePlaces(plan.range);
  Eigen::VectorXd rest, moved;
  for (std::size_t i = 0; i < places.size(); ++i) {
    cell.surface.evaluate(places[i].angle, places[i].displacement, rest, moved);
    if (i == 0) displacements.resize(moved.size(), static_cast<Eigen::Index>(places.size()));
    displacements.col(static_cast<Eigen::Index>(i)) = moved.cast<float>();
  }
  return member;
}

FamilyMember refitMember(const Family& family, const FamilyMember& member) {
  const Scene scene = family.member(member.coordinates);
  const SurrogatePlan plan = planMember(family, scene);
  FamilyMember result = ofCell(SurrogateData::fitForces(scene, plan, trainingResults(plan, member.paths)), plan);
  result.coordinates = member.coordinates;
  result.paths = member.paths;
  return result;
}

}  // namespace microinjection
