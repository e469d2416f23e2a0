#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "cell/mechanics/st_venant_kirchhoff_force.h"
#include "cell/mechanics/tensor_mass_force.h"

namespace microinjection {

struct ExplicitStepConfig {
  /// Computes the internal force.
  enum class Force {
    kKernel,        ///< StVenantKirchhoffForce
    kTensors,       ///< TensorMassForce, the same force in the paper's form
    kLinearTensors  ///< TensorMassForce of small strain
  };
  Lame lame;
  Force force = Force::kKernel;
  double density = 1000;            ///< kg/m^3
  double damping = 0;               ///< 1/s, gamma / M of every vertex, >= 0
  double safety = 0.8;              ///< ratio of the step to the largest stable one of the undeformed body, in (0, 1]
  std::optional<double> time_step;  ///< s, > 0, replaces safety; its stability is not checked, see frequencyBound
  std::vector<int> held;            ///< vertices that stay in place
  std::vector<int> tip;             ///< vertices that move with the needle's tip

  /// Throws ConfigError with all errors at once.
  void validate(std::size_t vertices) const;
};

/// Dynamics of a St-Venant-Kirchhoff (or linear) body on P1 tetrahedra by central differences:
/// equation (13) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted
/// biological cell injection", the paper's real-time scheme,
///
///     M a + gamma v + F_int(u) = F_ext,
///
/// with lumped mass (a quarter of each tetrahedron's to each vertex) and gamma = damping M:
/// velocities at half steps, v+ (1 + damping dt/2) = v- (1 - damping dt/2) + dt f / M. Its state of
/// rest is the quasi-static solution of the same mesh. Stable for dt < 2 / w with the highest
/// angular frequency w of M^-1 K, found by power iteration at the undeformed body; a body that
/// stiffens needs a smaller `safety`. To keep up with real time, `density` may be scaled: a step
/// grows with its square root. One thread at a time.
class ExplicitStep {
 public:
  /// Throws ConfigError, and std::invalid_argument as StVenantKirchhoffForce does or for a vertex
  /// without mass.
  ExplicitStep(const TetMesh& mesh, const ExplicitStepConfig& config);

  /// Makes these vertices move with the tip, instead of those before. They start where they are now;
  /// within some steps they come to be displaced from the undeformed body by the tip's displacement.
  /// Throws ConfigError, as the constructor does, and then changes nothing.
  void setTip(const std::vector<int>& vertices);
  /// Restores the undeformed body at rest.
  void reset();

  /// One time step, at the end of which the tip is displaced by this (m) from where it was set.
  /// Does not allocate.
  void step(const Eigen::Vector3d& tip_displacement);

  /// Force of the body on the needle, N, at the positions at the start of the last step.
  const Eigen::Vector3d& force() const { return force_; }

  double timeStep() const { return time_step_; }                       ///< s
  double highestFrequency() const { return highest_frequency_; }       ///< rad/s, undeformed; 0 with a given time_step
  double kineticEnergy() const;                                        ///< J
  bool hasInvertedElement() const;                                     ///< or a flat one
  const std::vector<double>& positions() const { return positions_; }  ///< m, xyz per vertex

 private:
  void holdTip();
  double findHighestFrequency();
  void evaluate(const std::vector<double>& positions, std::vector<double>& forces);

  std::vector<std::array<int, 4>> tetrahedra_;
  std::optional<StVenantKirchhoffForce> kernel_;  ///< either this or the tensors
  std::optional<TensorMassForce> tensors_;
  ExplicitStepConfig config_;
  std::vector<double> rest_, positions_, velocities_, forces_, displacements_;  ///< xyz per vertex
  std::vector<double> masses_;                                                  ///< kg, of each vertex
  std::vector<double> inverse_masses_;      ///< 1/kg, xyz per vertex; 0 for prescribed motion
  std::vector<Eigen::Vector3d> tip_start_;  ///< m, of each vertex of the tip at zero displacement; it approaches rest_
  double highest_frequency_ = 0;
  double time_step_ = 0;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

}  // namespace microinjection
