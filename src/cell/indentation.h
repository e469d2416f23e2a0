#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>

#include "cell/cell_model.h"
#include "contact/tip_patch.h"
#include "mechanics/equilibrium_system.h"
#include "mechanics/load_path.h"

namespace microinjection {

/// Quasi-static deformation of a cell under one sticking patch: every vertex of the patch moves by the displacement of
/// the tip. Keeps its state and continues from it, so a needle that moves little costs little. One thread at a time.
class Indentation : public LiveIndentation {
 public:
  /// Throws std::invalid_argument when the patch and the held vertices overlap or leave nothing free.
  Indentation(std::shared_ptr<const CellModel> cell, const TipPatch& patch);
  Indentation(const Indentation&) = delete;  // the path refers to the system
  Indentation& operator=(const Indentation&) = delete;

  /// The elastic cell: `duration` does not matter.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                            double duration = std::numeric_limits<double>::infinity()) override;

  Eigen::VectorXd displacement() const override;
  Eigen::Vector3d tipDisplacement() const override { return path_.translation(); }
  void reset() override { path_.reset(); }

 private:
  std::shared_ptr<const CellModel> cell_;
  EquilibriumSystem system_;
  LoadPath path_;
};

}  // namespace microinjection
