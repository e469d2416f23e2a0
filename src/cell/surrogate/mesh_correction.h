#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// By what the coarse mesh's forces are too large or too small: a smooth function of place, direction and length of the
/// tip's displacement, from paths that were solved on a finer mesh as well.
class MeshCorrection {
 public:
  /// Two meshes' samples at the same places and displacements, as far as both got.
  struct Pair {
    const std::vector<TrainingSample>* coarse;
    const std::vector<TrainingSample>* fine;
  };
  MeshCorrection(const EnergyScales& scales, const std::vector<Pair>& pairs);

  /// To multiply a coarse force with; 1 when there were no pairs.
  double factor(double angle, const Eigen::Vector3d& displacement) const;

 private:
  static constexpr int kTerms = 8;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Terms terms(double angle, const Eigen::Vector3d& displacement) const;

  EnergyScales scales_;
  Terms coefficients_ = Terms::Zero();  ///< of the factor's logarithm
};

/// Of each coarse path its samples, with the force of the same path on the fine mesh as far as that was solved, else
/// corrected; of each fine path nothing. `results` as `rays`.
std::vector<std::vector<TrainingSample>> betterForces(const EnergyScales& scales, const std::vector<TrainingRay>& rays,
                                                      const std::vector<TrainingResult>& results);

}  // namespace microinjection
