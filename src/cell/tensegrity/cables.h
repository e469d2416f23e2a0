#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Undeformed position of each node, m. Entries 3 n to 3 n + 2 of a state are node n's
/// displacement.
using NodePositions = std::vector<Eigen::Vector3d>;

/// Straight cables between nodes, which bear tension only: equations (9) and (10) of Ladjal, Hanus,
/// Ferreira,
///
///     tension = max(0, E S (l - l0) / l0 + eta S (dl/dt) / l0), eta = E times the retardation time.
///
/// The viscous term of the printed (10) lacks the section S and so is a stress, not a force; (9)
/// times S has it. In (10) l is the present length and l0 the one without load (the text has them
/// exchanged).
///
/// A load step of duration dt uses the rate at its end, (l - m) / dt, with the cable's own length m
/// before (implicit Euler). The tension is then k (l - r) where that is positive, with k = E S (1 +
/// retardation / dt) / l0 and the slack length r between l0 and m. Its potential is k/2 (l - r)^2.
/// A slack cable's own length is r: it creeps back to l0 while it is slack.
class Cables : public EnergyTerm {
 public:
  struct Cable {
    int a = 0, b = 0;             ///< nodes
    double rest_length = 0;       ///< l0, m, > 0
    double axial_stiffness = 0;   ///< E S, N, >= 0
    double retardation_time = 0;  ///< s, >= 0
  };

  /// `start`: initial state of the memory, as if held for an infinite time.
  Cables(std::shared_ptr<const NodePositions> node_positions, std::vector<Cable> cables, const Eigen::VectorXd& start);

  int elementCount() const override { return static_cast<int>(cables_.size()); }
  const std::vector<int>& entries(int cable) const override { return entries_[cable]; }
  /// False when a cable has no length.
  bool evaluate(int cable, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  /// True when some cable is viscous and `duration` is finite.
  bool beginStep(double duration) override;
  /// The state stays at equilibrium until another step begins.
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

  const Cable& cable(int cable) const { return cables_[cable]; }
  double length(int cable, const Eigen::VectorXd& state) const;   ///< m, between its ends
  double tension(int cable, const Eigen::VectorXd& state) const;  ///< N, in the present step

 private:
  struct Spring {
    double stiffness;     ///< k, N/m
    double slack_length;  ///< r, m
  };
  Spring spring(int cable) const;

  std::shared_ptr<const NodePositions> node_positions_;
  std::vector<Cable> cables_;
  std::vector<std::vector<int>> entries_;
  /// Own lengths of the cables, m: before the present step, at the last accepted state, and
  /// initially.
  std::vector<double> lengths_, accepted_, start_lengths_;
  double duration_;  ///< s, of the present step
};

}  // namespace microinjection
