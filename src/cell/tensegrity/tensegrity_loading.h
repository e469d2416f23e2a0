#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/load_path.h"
#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {

/// The structure with some nodes moved as one: by the needle's tip, or by whatever loads it. Quasi-static, or where
/// cables or membrane are viscous, in implicit steps of time; inertia is nothing at this scale. Keeps its state and
/// continues from it.
///
/// Where stable equilibria end (a strut snaps aside, cables go slack) the displacement is kept and the structure falls
/// to the rest that minimising its energy leads to, as a damped one would (viscous parts: as far as they let it in the
/// time of that step); snaps() counts it. One thread at a time.
class TensegrityLoading {
 public:
  /// Throws std::invalid_argument when a following node is held.
  TensegrityLoading(std::shared_ptr<const TensegrityStructure> structure, const std::vector<int>& following);
  TensegrityLoading(const TensegrityLoading&) = delete;  // the path refers to the system
  TensegrityLoading& operator=(const TensegrityLoading&) = delete;

  /// As LoadPath::advance.
  LoadPath::Result advance(const Eigen::Vector3d& target, double duration = std::numeric_limits<double>::infinity());

  /// Back to the structure at rest.
  void reset();

  const TensegrityStructure& structure() const { return *structure_; }
  const Cables& cables() const { return *parts_.cables; }
  const Eigen::VectorXd& state() const { return path_->state(); }
  Eigen::Vector3d displacement() const { return path_->state().tail<3>(); }  ///< m, of the following nodes
  /// N, of the structure on what moves them.
  Eigen::Vector3d force() const { return -path_->reaction(); }
  const Eigen::Matrix3d& stiffness() const { return path_->stiffness(); }  ///< N/m, d(force) = -stiffness d(way)
  int snaps() const { return snaps_; }

 private:
  double snap(const Eigen::Vector3d& way, double duration);
  bool fall(const Eigen::Vector3d& way, bool viscous);
  LoadPathConfig pathConfig() const;

  std::shared_ptr<const TensegrityStructure> structure_;
  TensegrityStructure::Parts parts_;
  EquilibriumSystem system_;
  std::unique_ptr<LoadPath> path_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< m, displacement at which path_ set out
  int snaps_ = 0;
};

}  // namespace microinjection
