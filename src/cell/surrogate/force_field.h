#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/energy_fit.h"

namespace microinjection {

/// Force on the tip as a function of the contact point and the displacement since, without the
/// condition that it is the gradient of an energy: with sticking, the force at the end of a
/// straight path is none. In the contact frame, with a = u_x / |u|, b = u_y / |u|, c as in
/// EnergyExpansion and three such expansions A, B, Z:
///
///     F = (c A + a B, b B, Z)
///
/// This is the form of any smooth vector that is rotated and mirrored together with contact point
/// and displacement.
class ForceField {
 public:
  ForceField() = default;
  explicit ForceField(const EnergyScales& scales);

  bool empty() const { return axial_.size() == 0; }
  /// Changes to a unit of length and one of energy, given in the new ones.
  void changeUnits(double length, double energy);

  /// Least-squares fit to the samples' forces, with errors relative to each force.
  void fit(const std::vector<TrainingSample>& samples);

  /// Multiplies the force by a function of s, see EnergyExpansion.
  void scaleAlongPaths(const std::function<double(double)>& factor, const std::function<double(double)>& size);

  /// The field at one contact point. Only the first makeLocal allocates.
  class Local {
   public:
    /// N, and its derivative by the displacement, N/m. Zero at zero displacement.
    Eigen::Vector3d evaluate(const Eigen::Vector3d& displacement, Eigen::Matrix3d& jacobian) const;

   private:
    friend class ForceField;
    double scaled_angle_ = 0;
    EnergyExpansion::Local away_, lateral_, axial_;
  };
  void makeLocal(double angle, Local& local) const;

  /// Coefficients of the three expansions in sequence, for storage.
  Eigen::VectorXd coefficients() const;
  void setCoefficients(const Eigen::VectorXd& coefficients);

 private:
  EnergyScales scales_;
  EnergyExpansion away_, lateral_, axial_;  ///< A, B, Z
};

}  // namespace microinjection
