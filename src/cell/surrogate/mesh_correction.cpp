#include "cell/surrogate/mesh_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kNear = 0.02;      ///< over the longest displacement: a shorter contact has few points of the mesh
constexpr double kScatter = 0.01;   ///< relative, of coarse forces
constexpr double kExpected = 0.05;  ///< size of a coefficient: those that the pairs do not determine stay small

bool samePath(const TrainingRay& a, const TrainingRay& b) { return a.angle == b.angle && a.target == b.target; }

}  // namespace

MeshCorrection::MeshCorrection(const EnergyScales& scales, const std::vector<Pair>& pairs) : scales_(scales) {
  Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Identity();
  normal *= std::pow(kScatter / kExpected, 2);
  Terms right = Terms::Zero();
  for (const Pair& pair : pairs) {
    for (std::size_t i = 0; i < std::min(pair.coarse->size(), pair.fine->size()); ++i) {
      const TrainingSample &coarse = (*pair.coarse)[i], &fine = (*pair.fine)[i];
      if (coarse.force.isZero(0) || fine.force.isZero(0)) continue;
      const double length = coarse.displacement.norm() / scales_.length;
      const double weight = std::pow(length / (length + kNear), 2);  // scatter is larger near first contact
      const Terms terms = this->terms(coarse.angle, coarse.displacement);
      normal += weight * terms * terms.transpose();
      right += weight * std::log(fine.force.norm() / coarse.force.norm()) * terms;
    }
  }
  coefficients_ = normal.ldlt().solve(right);
}

double MeshCorrection::factor(double angle, const Eigen::Vector3d& displacement) const {
  return std::exp(terms(angle, displacement).dot(coefficients_));
}

MeshCorrection::Terms MeshCorrection::terms(double angle, const Eigen::Vector3d& displacement) const {
  const double length = displacement.norm(), scaled_angle = angle / scales_.angle;
  const double away = length > 0 ? displacement.x() / length : 0, flat = length > 0 ? 1 + displacement.z() / length : 0;
  const double near = kNear / (kNear + length / scales_.length);
  const Eigen::Vector4d smooth(1, scaled_angle * scaled_angle, scaled_angle * away, flat);
  Terms result;
  result << smooth, near * smooth;
  return result;
}

std::vector<std::vector<TrainingSample>> betterForces(const EnergyScales& scales, const std::vector<TrainingRay>& rays,
                                                      const std::vector<TrainingResult>& results) {
  std::vector<const std::vector<TrainingSample>*> fine(rays.size(), nullptr);  // of the fine path with the same target
  std::vector<MeshCorrection::Pair> pairs;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = 0; rays[i].level == kCoarseLevel && j < rays.size(); ++j) {
      if (rays[j].level != kFineLevel || !samePath(rays[i], rays[j])) continue;
      fine[i] = &results[j].samples;
      pairs.push_back({&results[i].samples, fine[i]});
    }
  }
  const MeshCorrection correction(scales, pairs);
  std::vector<std::vector<TrainingSample>> better(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].level != kCoarseLevel) continue;
    better[i] = results[i].samples;
    for (std::size_t k = 0; k < better[i].size(); ++k) {
      TrainingSample& sample = better[i][k];
      const bool finer = fine[i] && k < fine[i]->size();
      sample.force = finer ? (*fine[i])[k].force
                           : Eigen::Vector3d(sample.force * correction.factor(sample.angle, sample.displacement));
    }
  }
  return better;
}

}  // namespace microinjection
