#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/contact/tip_patch.h"
#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/load_path.h"
#include "cell/model/indentation_solution.h"
#include "cell/model/p1_cell.h"

namespace microinjection {

/// Quasi-static deformation of a cell under one sticking patch: every vertex of the patch moves by
/// the displacement of the tip. It keeps its state and continues from it, so that small motions are
/// fast. One thread at a time.
class Indentation : public TipPath {
 public:
  /// Throws std::invalid_argument when the patch and the held vertices overlap or leave nothing
  /// free.
  Indentation(std::shared_ptr<const P1Cell> cell, const TipPatch& patch);
  Indentation(const Indentation&) = delete;  // the path refers to the system
  Indentation& operator=(const Indentation&) = delete;

  /// Equilibrium at `tip_displacement` (m). The tip moves along the straight line from its present
  /// position in adaptive load steps. On failure the state stays at the last equilibrium.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement);

  /// Displacement of the mesh's vertices, m, xyz per vertex.
  Eigen::VectorXd displacement() const;

  IndentationSolution follow(const TipMotion& move) override { return solve(move.displacement); }
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const override { return nullptr; }
  Eigen::VectorXd surfaceDisplacement() const override;

  /// Displacement of the tip in the present state, m.
  const Eigen::Vector3d& tipDisplacement() const { return path_.translation(); }

  /// Returns to the undeformed state.
  void reset() { path_.reset(); }

 private:
  std::shared_ptr<const P1Cell> cell_;
  EquilibriumSystem system_;
  LoadPath path_;
};

}  // namespace microinjection
