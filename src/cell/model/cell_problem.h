#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/load_path.h"
#include "cell/model/indentation_solution.h"
#include "cell/model/scene.h"

namespace microinjection {

template <int Dim>
class TipContact;

/// Symmetry of a scene in space and its loads. kMirror: the mesh is the half y >= 0
/// (makeHalfSceneMesh) and the tip moves in the plane y = 0; forces and stiffness are those of the
/// whole cell (zero across the plane). It does not find states that break the symmetry.
enum class Symmetry { kNone, kMirror };

/// A scene on a mesh, in space (Dim 3) or, on the axis, in its section (Dim 2). Keeps its state and
/// continues from it. One thread at a time.
template <int Dim>
class CellProblem {
 public:
  /// Throws std::invalid_argument when the needle's disc and the holding pipette overlap, or when
  /// kMirror is used without the half y >= 0 of a mesh in space and a contact point in y = 0.
  CellProblem(const Scene& scene, QuadraticMesh<Dim> mesh, ElementKind element, Symmetry symmetry = Symmetry::kNone);
  /// A body that only the constraints' displacements load. Throws as LoadPath does.
  CellProblem(std::shared_ptr<LayeredBody<Dim>> body, const Constraints& constraints, const LoadPathConfig& path_config,
              SymmetricSolver::Method method);

  /// Equilibrium with the tip displaced by this (m) from first contact with the undeformed cell.
  /// The tip moves along the straight line from its present position at constant speed in
  /// `duration` (s; infinite: viscous stresses have relaxed). On failure the state stays at the
  /// last equilibrium. A section takes displacements along z only.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                            double duration = std::numeric_limits<double>::infinity());

  /// Returns to the undeformed state.
  void reset() { path_->reset(); }

  const LayeredBody<Dim>& body() const { return *body_; }
  const Eigen::VectorXd& state() const { return path_->state(); }  ///< see LayeredBody
  const Eigen::Vector3d& tipDisplacement() const { return path_->translation(); }
  int unknowns() const { return system_->freeSize(); }

 private:
  Constraints constraints(const Scene& scene) const;
  void addContact(const Scene& scene, EquilibriumSystem::Terms& terms);
  static LoadPathConfig pathConfig(const Scene& scene, bool linear);

  Symmetry symmetry_ = Symmetry::kNone;
  std::shared_ptr<LayeredBody<Dim>> body_;
  std::shared_ptr<TipContact<Dim>> contact_;  ///< of a rounded tip
  double deepest_ = 0;                        ///< m, largest allowed penetration
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
};

}  // namespace microinjection
