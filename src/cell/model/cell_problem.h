#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/load_path.h"
#include "cell/model/indentation_solution.h"
#include "cell/model/scene.h"

namespace microinjection {

template <int Dim>
class RigidContact;
template <int Dim>
class SuctionLoad;
class ProximalAnchor;

/// Symmetry of a scene in space and its loads. kMirror: the mesh is the half y >= 0
/// (makeHalfSceneMesh) and the tip moves in the plane y = 0; forces and stiffness are those of the
/// whole cell (zero across the plane). It does not find states that break the symmetry.
enum class Symmetry { kNone, kMirror };

/// A cell that suction holds, in equilibrium.
struct HeldCell {
  double pressure = 0;       ///< Pa, gauge, in the bore
  double tongue_length = 0;  ///< m, from the plane of the lip's crest to the surface's furthest point in the bore
  double tongue_volume = 0;  ///< m^3, of the cell behind that plane, in the bore
  double seal_radius = 0;    ///< m, of the circle within the contact with the lip at which the pressure is taken to end
  double clamping_force = 0;  ///< N, of the lip on the cell, along the axis; suction and needle balance it
  Eigen::Matrix2Xd outline;   ///< m, (r, z) of the deformed surface, from the pole in the mouth to the other one
  double imbalance = 0;       ///< N, along the axis, that the solution has not balanced
};

/// A scene on a mesh, in space (Dim 3) or, on the axis, in its section (Dim 2). Keeps its state and
/// continues from it. One thread at a time.
template <int Dim>
class CellProblem {
 public:
  /// Throws std::invalid_argument when the needle's disc and the holding pipette overlap, or when
  /// kMirror is used without the half y >= 0 of a mesh in space and a contact point in y = 0. Throws ConfigError for a
  /// cell in space that suction holds, unless it has mirror symmetry.
  CellProblem(const Scene& scene, QuadraticMesh<Dim> mesh, ElementKind element, Symmetry symmetry = Symmetry::kNone);
  /// A body that only the constraints' displacements load. Throws as LoadPath does.
  CellProblem(std::shared_ptr<LayeredBody<Dim>> body, const Constraints& constraints, const LoadPathConfig& path_config,
              SymmetricSolver::Method method);

  /// Equilibrium with the tip displaced by this (m) from first contact with the undeformed cell.
  /// The tip moves along the straight line from its present position at constant speed in
  /// `duration` (s; infinite: viscous stresses have relaxed). On failure the state stays at the
  /// last equilibrium. A section takes displacements along z only. First contact with a cell that suction holds is that
  /// with the cell as its pressure has deformed it, straight below the needle.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                            double duration = std::numeric_limits<double>::infinity());

  /// The cell held by this pressure (Pa, gauge) with the needle away. @pre the scene's holding pipette has a mouth
  LoadPath::Result hold(double pressure);
  /// Of the last equilibrium. @pre the scene's holding pipette has a mouth
  HeldCell held() const;

  /// Returns to the undeformed state.
  void reset();

  const LayeredBody<Dim>& body() const { return *body_; }
  const Eigen::VectorXd& state() const { return path_->state(); }  ///< see LayeredBody
  /// m, of the needle, from its first contact: see solve()
  Eigen::Vector3d tipDisplacement() const;
  int unknowns() const { return system_->freeSize(); }

 private:
  Constraints constraints(const Scene& scene) const;
  void addContact(const Scene& scene, EquilibriumSystem::Terms& terms);
  void addSuction(const Scene& scene, EquilibriumSystem::Terms& terms);
  double touchHeight() const;
  static LoadPathConfig pathConfig(const Scene& scene, bool linear);

  Symmetry symmetry_ = Symmetry::kNone;
  std::shared_ptr<LayeredBody<Dim>> body_;
  std::shared_ptr<RigidContact<Dim>> contact_;  ///< of a rounded tip
  double deepest_ = 0;                          ///< m, largest allowed penetration
  std::shared_ptr<RigidContact<Dim>> lip_;      ///< these are of a cell that suction holds, else empty
  std::shared_ptr<SuctionLoad<Dim>> suction_;
  std::shared_ptr<ProximalAnchor> anchor_;
  double holding_pressure_ = 0;  ///< Pa, that solve() holds the cell by
  double away_ = 0;              ///< m, of the needle while the cell is taken
  double deepest_into_lip_ = 0;  ///< m, largest allowed penetration
  bool on_axis_ = true;          ///< the needle's line
  std::optional<double> touch_;  ///< m, tip's translation along z at first contact with the held cell; none: not held
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
};

}  // namespace microinjection
