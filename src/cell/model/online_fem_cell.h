#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/contact/rounded_tip.h"
#include "cell/mesh/quadratic_mesh.h"
#include "cell/model/online_cell.h"

namespace microinjection {

/// Live model of any scene: P2-P0 elements, which do not lock, on a swept mesh (see sweepSection)
/// that is coarser than those of converged solutions. Its force is some per cent too large, and it
/// follows the tip at some micrometres a second (`./dev bench live_models`). Friction and
/// viscoelasticity depend on the tip's speed, as far as the solutions keep up with it. The needle
/// must be upright.
class OnlineFemCell : public OnlineCell {
 public:
  static constexpr double kLevel = -2;  ///< see makeSceneMesh

  /// Limits BLAS to one thread, see SymmetricSolver::useOneThread. Throws ConfigError when the
  /// scene is not valid or its cell not stable at rest.
  explicit OnlineFemCell(const Scene& scene);

  const Scene& scene() const override { return scene_; }
  std::string description() const override;
  const char* refusal(const Eigen::Vector3d& axis) const override;
  std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                       int& hint) const override;
  bool isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
               const Eigen::Vector3d& contact_point) const override;
  /// Contact points closer to the cell's axis than a tenth of the tip's radius are moved onto it.
  ContactPoint contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const override;
  Eigen::Vector3d preparedDisplacement() const override;
  std::unique_ptr<TipPath> path(const ContactPoint& contact_point) const override;
  Surface undeformedSurface() const override { return surface_; }
  std::vector<std::uint32_t> onSurface(const TipPatch& /*patch*/) const override { return {}; }

 private:
  Scene scene_;
  std::optional<RoundedTip> tip_;  ///< none: a disc
  QuadraticMesh<2> section_;
  Surface surface_;
  int elements_ = 0, unknowns_ = 0;
};

}  // namespace microinjection
