#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/contact/rounded_tip.h"
#include "cell/mesh/quadratic_mesh.h"
#include "cell/model/live_cell.h"

namespace microinjection {

/// Live model of any continuum scene: P2-P0 elements, which do not lock, on a swept mesh (see sweepSection) that is one
/// halving coarser than the coarsest of ConvergedForce. Element and mesh were chosen by measurement (`./dev bench
/// live_models`, doc/reference/benchmarks.md, Live cells; hemisphere of 3 um on the axis, against the converged
/// section):
///
///     element, level   a solution (median)   force error at 1.5, 3, 6, 9 um
///     P1, 0                 92 ms            36, 32, 35, 38 %
///     MINI, -2              51 ms            44, 53, 48, 44 %
///     P1-P1, -1            114 ms            21, 21, 19, 21 %
///     P2-P0, -2             95 ms            8, 1.1, 2.6, 2.4 %      this class
///     P2-P0, -1            653 ms            0.8, 0.9, 0.9, 1.3 %    too slow for a hand
///
/// On the axis the solutions follow the tip up to 8 um/s, at 30 degrees up to 4 um/s. Each one moves the tip by a
/// quarter of its radius at most, so that solutions stay frequent while the needle is fast; friction and
/// viscoelasticity depend on the tip's speed as far as the solutions keep up with it.
///
/// The section is meshed once, in the constructor, and swept about the contact point whenever that changes, so that no
/// mesher runs in a session. The sweep needs an upright needle (within 2.5 degrees), and refuses a needle that is too
/// far from the cell's axis for its elements to stay in order.
class LiveFemCell : public LiveCell {
 public:
  static constexpr double kLevel = -2;  ///< see makeSceneMesh

  /// Limits BLAS to one thread, see SymmetricSolver::useOneThread. Throws ConfigError when the
  /// scene is not valid or its cell not stable at rest.
  /// Adhesion is refused, because LiveCellModel would mistake its extrapolation for a pull of the cell.
  explicit LiveFemCell(const Scene& scene);

  const Scene& scene() const override { return scene_; }
  std::string description() const override;
  const char* refusal(const Eigen::Vector3d& axis) const override;
  std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                       int& hint) const override;
  bool isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
               const Eigen::Vector3d& contact_point) const override;
  /// Contact points closer to the cell's axis than a tenth of the tip's radius are moved onto it.
  ContactPoint contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const override;
  /// A tenth of the tip's radius down, because a penalty contact has no stiffness at the touch; none under a disc.
  Eigen::Vector3d preparedDisplacement() const override;
  /// Throws std::runtime_error for a contact point too far from the cell's axis.
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
