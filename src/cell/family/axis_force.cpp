#include "cell/family/axis_force.h"

#include <stdexcept>
#include <vector>

#include "cell/family/family_member.h"
#include "cell/surrogate/axis_ray.h"

namespace microinjection {
namespace {

constexpr int kPoints = 6;   ///< of a coordinate
constexpr double kAt = 0.5;  ///< of the range's depth

double unit(const EnergyScales& scales) { return scales.energy / scales.length; }

}  // namespace

ChebyshevGrid axisForceGrid(const Family& family) { return {family.dimension(), kPoints}; }

double solveAxisForce(const Family& family, const Eigen::VectorXd& coordinates) {
  const Scene member = family.member(coordinates);
  const Preparation plan = planMember(family, member);
  const std::vector<TrainingSample> samples = solveAxis(member, {kAt * plan.range.depth});
  if (samples.empty()) throw std::runtime_error("on the axis a member has no solution to half of its depth");
  return samples.front().force.norm() / unit(plan.scales);
}

double axisForce(const ForceField& field, const Preparation& plan) {
  ForceField::Local local;
  field.makeLocal(0, local);
  Eigen::Matrix3d jacobian;
  return local.evaluate(-kAt * plan.range.depth * Eigen::Vector3d::UnitZ(), jacobian).norm() / unit(plan.scales);
}

}  // namespace microinjection
