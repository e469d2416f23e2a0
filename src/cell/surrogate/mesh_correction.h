#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Ratio of fine to coarse meshes' forces: a smooth function of contact point, direction and length
/// of the tip's displacement, from paths that were solved on both meshes.
class MeshCorrection {
 public:
  /// Samples of two meshes at the same contact points and displacements, as far as both were
  /// solved.
  struct Pair {
    const std::vector<TrainingSample>* coarse;
    const std::vector<TrainingSample>* fine;
  };
  MeshCorrection(const EnergyScales& scales, const std::vector<Pair>& pairs);

  /// Factor for a coarse force; 1 without pairs.
  double factor(double angle, const Eigen::Vector3d& displacement) const;

 private:
  static constexpr int kTerms = 8;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Terms terms(double angle, const Eigen::Vector3d& displacement) const;

  EnergyScales scales_;
  Terms coefficients_ = Terms::Zero();  ///< of the factor's logarithm
};

/// Samples of each coarse path with forces of the same path on the fine mesh, or corrected ones
/// where there are none; fine paths give no samples. `results` belong to `rays`.
std::vector<std::vector<TrainingSample>> betterForces(const EnergyScales& scales, const std::vector<TrainingRay>& rays,
                                                      const std::vector<TrainingResult>& results);

}  // namespace microinjection
