#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Highest derivative of an energy that is needed.
enum class Order { kEnergy, kGradient, kHessian };

/// Energy of one element, J, with its derivatives by the entries of the state that it depends on.
struct LocalEnergy {
  bool zero = false;  ///< the energy and its derivatives vanish; derivatives are not filled
  double energy = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< symmetric, both triangles
};

/// Part of a system's energy that is a sum over elements: a body's elasticity, a surface's tension,
/// the contact with a tip.
///
/// Terms are energies rather than forces, also where physics dissipates: friction and viscosity take part with the
/// incremental potential of the load step. The tangent of an energy is symmetric, so that Cholesky's factorisation
/// applies; a stable equilibrium is one with a positive definite tangent; and LoadPath can compare the gain of energy
/// with the tip's work, by which it notices a jump to another branch. A test of a new term checks its gradient and
/// Hessian against differences by expectDerivatives() (test/cell/mechanics/term_derivatives.h).
///
/// A load step, in which the history of a term changes only at the end:
///
///     beginStep() --> evaluate() in each Newton iteration --> equilibrium --> settle() --false--> accept()
///          ^                    ^                                                |
///          |                    `----------- true: contact points changed -------'
///          `-- no equilibrium: the step is repeated, half as long
///
/// The state is one vector of lengths, m: displacements, pressures scaled to lengths, and at its
/// end the three coordinates of the tip's translation. A pressure is a Lagrange multiplier: the
/// energy is stationary, not minimal.
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;
  virtual int elementCount() const = 0;

  /// Entries of the state on which an element's energy depends, in the order of its derivatives; no
  /// entry twice.
  virtual const std::vector<int>& entries(int element) const = 0;

  /// False when the energy is not defined at this state, or the state is not admissible (an
  /// inverted element).
  virtual bool evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const = 0;

  /// Whether the tangent of an element may jump between two iterations, because points come into
  /// contact. The answer never changes. Where other elements of the same term contribute, the
  /// solver has to factorise in each iteration.
  virtual bool isNonsmooth(int /*element*/) const { return false; }

  /// Begins a load step of `duration` (s, > 0; infinite: viscous stresses have relaxed), or repeats
  /// one. Changes that settle() made in an earlier attempt are discarded. Returns true when the
  /// energy depends on the duration.
  virtual bool beginStep(double /*duration*/) { return false; }

  /// Called at an equilibrium at the end of a load step: makes the contact changes of the step
  /// permanent. Returns true when the energy has changed, so that the equilibrium must be solved
  /// again in the same step.
  virtual bool settle(const Eigen::VectorXd& /*state*/) { return false; }

  /// Called at the last equilibrium of a load step: stores the history (friction, viscosity).
  virtual void accept(const Eigen::VectorXd& /*state*/) {}

  /// Discards the history: back to the undeformed state.
  virtual void reset() {}
};

}  // namespace microinjection
