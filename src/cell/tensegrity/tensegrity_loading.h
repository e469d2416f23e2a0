#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/load_path.h"
#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {

/// The structure with some nodes moved together by the needle's tip or another load. It is
/// quasi-static or, with viscous cables or membrane, moves in implicit time steps; inertia is
/// negligible at this scale. It keeps its state and continues from it.
///
/// Where stable equilibria end (a strut snaps aside, cables become slack) the displacement is kept
/// and the structure relaxes to the state of rest that minimising its energy finds, as a damped
/// structure would (viscous parts: as far as they can in the time of that step); snaps() counts
/// these events. One thread at a time.
class TensegrityLoading {
 public:
  /// Throws std::invalid_argument when a following node is held.
  TensegrityLoading(std::shared_ptr<const TensegrityStructure> structure, const std::vector<int>& following);
  TensegrityLoading(const TensegrityLoading&) = delete;  // the path refers to the system
  TensegrityLoading& operator=(const TensegrityLoading&) = delete;

  /// As LoadPath::advance.
  LoadPath::Result advance(const Eigen::Vector3d& target, double duration = std::numeric_limits<double>::infinity());

  /// Returns to the structure at rest.
  void reset();

  const TensegrityStructure& structure() const { return *structure_; }
  const Cables& cables() const { return *parts_.cables; }
  const Eigen::VectorXd& state() const { return path_->state(); }
  Eigen::Vector3d displacement() const { return path_->state().tail<3>(); }  ///< m, of the following nodes
  /// Force of the structure on the following nodes' load, N.
  Eigen::Vector3d force() const { return -path_->reaction(); }
  const Eigen::Matrix3d& stiffness() const { return path_->stiffness(); }  ///< N/m, -d(force)/d(displacement)
  int snaps() const { return snaps_; }

 private:
  double snap(const Eigen::Vector3d& path, double duration);
  bool relax(const Eigen::Vector3d& increment, bool viscous);
  LoadPathConfig pathConfig() const;

  std::shared_ptr<const TensegrityStructure> structure_;
  TensegrityStructure::Parts parts_;
  EquilibriumSystem system_;
  std::unique_ptr<LoadPath> path_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< m, displacement at which path_ started
  int snaps_ = 0;
};

}  // namespace microinjection
