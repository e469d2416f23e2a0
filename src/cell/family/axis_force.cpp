#include "cell/family/axis_force.h"
#include "cell/surrogate/axis_ray.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "cell/family/family_member.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {
namespace {

constexpr int kPointsOfCoordinate = 6;  ///< of a coordinate
constexpr double kAt = 0.5;             ///< of the range's depth
constexpr double kGrowth = 3;           ///< power of s with which a round tip's force grows at first (Hertz)
constexpr int kLeastDepths = 6;         ///< that the section must reach: half of the range's depth
/// Weights of Floater and Hormann's rational interpolation of degree 3 at the ends of equal steps; 8 in between
/// (Numerische Mathematik 107 (2007) 315).
constexpr double kEndWeights[] = {1, 4, 7};

double unit(const EnergyScales& scales) { return scales.energy / scales.length; }

double root(int index) { return static_cast<double>(index + 1) / kAxisDepths; }

double interpolationWeight(int index) {
  const int from_end = std::min(index, kAxisDepths - 1 - index);
  return (index % 2 == 0 ? 1 : -1) * (from_end < 3 ? kEndWeights[from_end] : 8);
}

}  // namespace

ChebyshevGrid axisForceGrid(const Family& family) { return {family.dimension(), kPointsOfCoordinate}; }

Eigen::VectorXd solveAxisForces(const Family& family, const Eigen::VectorXd& coordinates) {
  const Scene member = family.member(coordinates);
  const SurrogatePlan plan = planMember(family, member);
  std::vector<double> depths;
  for (int i = 0; i < kAxisDepths; ++i) depths.push_back(std::pow(root(i), 2) * plan.range.axis_depth);
  const std::vector<TrainingSample> samples = solveAxis(member, depths);
  const auto count = static_cast<int>(samples.size());
  if (count < kLeastDepths) throw std::runtime_error("on the axis a member has no solution to half of its depth");
  Eigen::VectorXd forces(kAxisDepths);
  for (int i = 0; i < kAxisDepths; ++i) {
    forces[i] = i < count ? samples[static_cast<std::size_t>(i)].force.norm() / unit(plan.scales)
                          : forces[i - 1] * forces[count - 1] / forces[count - 2];
  }
  return forces;
}

AxisCurve axisCurve(const Eigen::VectorXd& log_forces) {
  return [log_forces](double s) {
    double sum = 0, weights = 0;
    for (int i = 0; i < kAxisDepths; ++i) {
      const double distance = s - root(i);
      if (distance == 0) return std::exp(log_forces[i]);
      const double weight = interpolationWeight(i) / distance;
      sum += weight * (log_forces[i] - kGrowth * std::log(root(i)));  // varies slowly
      weights += weight;
    }
    return std::pow(s, kGrowth) * std::exp(sum / weights);
  };
}

AxisCurve axisCurve(const ForceField& field, const EnergyScales& scales) {
  ForceField::Local local;
  field.makeLocal(0, local);
  return [local, scales](double s) {
    Eigen::Matrix3d jacobian;
    return local.evaluate(-s * s * scales.length * Eigen::Vector3d::UnitZ(), jacobian).norm() / unit(scales);
  };
}

AxisCurve axisRatio(const AxisCurve& curve, const AxisCurve& other, double axis_share) {
  const double first = root(0), last = std::max(first, std::sqrt(std::min(1.0, axis_share)));
  return [=](double s) {
    const double known = std::clamp(s, first, last);
    return curve(known) / other(known);
  };
}

double axisForce(const ForceField& field, const SurrogatePlan& plan) {
  return axisCurve(field, plan.scales)(std::sqrt(kAt * plan.range.depth / plan.range.axis_depth));
}

}  // namespace microinjection
