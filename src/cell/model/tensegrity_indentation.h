#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "cell/contact/tip_patch.h"
#include "cell/model/cell_model.h"
#include "cell/model/contact_time.h"
#include "cell/model/live_cell.h"
#include "cell/tensegrity/tensegrity_loading.h"

namespace microinjection {

/// A tensegrity cell under one sticking patch of its membrane: every vertex of the patch moves by
/// the displacement of the tip. Keeps its state and continues from it. One thread at a time.
class TensegrityIndentation : public TipPath {
 public:
  /// Throws std::invalid_argument when the patch and the held strut ends overlap.
  TensegrityIndentation(std::shared_ptr<const TensegrityStructure> structure, const TipPatch& patch);

  /// Equilibrium at `tip_displacement` (m). The tip moves along the straight line from its present
  /// position in `duration` (s; infinite: viscous stresses have relaxed). On failure the state
  /// stays at the last equilibrium.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                            double duration = std::numeric_limits<double>::infinity());
  Eigen::Vector3d tipDisplacement() const { return loading_.displacement(); }  ///< m, in the present state
  void reset() { loading_.reset(); }                                           ///< removes the needle

  IndentationSolution follow(const TipMotion& move) override;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest() const override { return nullptr; }
  Eigen::VectorXd surfaceDisplacement() const override;
  std::vector<CellModel::Member> members() const override;

 private:
  TensegrityLoading loading_;
  ContactTime clock_;
};

/// Struts, each in several pieces, then cables, in a state. `cables` must be from
/// TensegrityStructure::makeParts().
std::vector<CellModel::Member> tensegrityMembers(const TensegrityStructure& structure, const Cables& cables,
                                                 const Eigen::VectorXd& state);

}  // namespace microinjection
