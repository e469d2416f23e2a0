#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/contact/tip_patch.h"
#include "cell/model/cell_problem.h"
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

  /// See CellProblem.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement) { return problem_.solve(tip_displacement); }
  const Eigen::VectorXd& state() const { return problem_.state(); }
  Eigen::Vector3d tipDisplacement() const { return problem_.tipDisplacement(); }
  void reset() { problem_.reset(); }

  IndentationSolution follow(const TipMotion& move) override { return solve(move.displacement); }
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const override { return nullptr; }
  Eigen::VectorXd surfaceDisplacement() const override;

 private:
  std::shared_ptr<const P1Cell> cell_;
  CellProblem<3> problem_;
};

}  // namespace microinjection
