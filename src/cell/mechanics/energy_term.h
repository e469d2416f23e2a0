#pragma once

#include <Eigen/Core>
#include <vector>

namespace microinjection {

/// Up to which derivative an energy is wanted.
enum class Order { kEnergy, kGradient, kHessian };

/// Energy of one element, J, with its derivatives by the state's entries that it depends on.
struct LocalEnergy {
  bool zero = false;  ///< nothing to add: derivatives are not filled
  double energy = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;  ///< symmetric, both triangles
};

/// Part of a system's energy, a sum over elements: a body's elasticity, a surface's tension, the contact with a tip.
///
/// The state is one vector of lengths, m: displacements, pressures scaled to lengths, and at its end the three
/// coordinates of the tip's translation. A pressure is a Lagrange multiplier: the energy is stationary, not minimal.
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;
  virtual int elementCount() const = 0;

  /// Entries of the state that an element's energy depends on, in the order of its derivatives; no entry twice.
  virtual const std::vector<int>& entries(int element) const = 0;

  /// False when the energy is not defined at this state, or the state is not admissible (an inverted element).
  virtual bool evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const = 0;

  /// A load step that takes `duration` (s, > 0; infinite: so slowly that nothing viscous resists) begins, or is tried
  /// once more; what settled in the try before is forgotten. True when the energy depends on the duration.
  virtual bool beginStep(double /*duration*/) { return false; }

  /// An equilibrium at the end of a load step: what has come into contact or left it does so for good. True when the
  /// energy is another function from now on, so that the equilibrium must be found once more, in the same step.
  virtual bool settle(const Eigen::VectorXd& /*state*/) { return false; }

  /// The last equilibrium of a load step: what remembers remembers it.
  virtual void accept(const Eigen::VectorXd& /*state*/) {}

  /// Forgets: back to the undeformed state.
  virtual void reset() {}
};

}  // namespace microinjection
