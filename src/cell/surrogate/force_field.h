#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/energy_fit.h"

namespace microinjection {

/// Force on the tip as a function of where it touched and how it moved since, without the demand that it be the
/// gradient of an energy: where points stick as they touch, the force at the end of a straight path is none. In the
/// frame of the place, with a = u_x / |u|, b = u_y / |u|, c as in EnergyExpansion and three such expansions A, B, Z:
///
///     F = (c A + a B, b B, Z)
///
/// which is the form of any smooth vector that turns and is mirrored with place and displacement.
class ForceField {
 public:
  ForceField() = default;
  explicit ForceField(const EnergyScales& scales);

  bool empty() const { return axial_.size() == 0; }

  /// Nearest to the samples' forces, each relative to its size.
  void fit(const std::vector<TrainingSample>& samples, const EnergyFitConfig& config = {});

  /// At one place. Allocates in makeLocal of the first place only.
  class Local {
   public:
    /// N, and its derivative by the displacement, N/m. Zero at no displacement.
    Eigen::Vector3d evaluate(const Eigen::Vector3d& displacement, Eigen::Matrix3d& jacobian) const;

   private:
    friend class ForceField;
    double contact_frame_ = 0;
    EnergyExpansion::Local away_, lateral_, axial_;
  };
  void makeLocal(double angle, Local& local) const;

  /// Coefficients of the three, one after another: to be stored.
  Eigen::VectorXd coefficients() const;
  void setCoefficients(const Eigen::VectorXd& coefficients);

 private:
  EnergyScales scales_;
  EnergyExpansion away_, lateral_, axial_;  ///< A, B, Z
};

}  // namespace microinjection
