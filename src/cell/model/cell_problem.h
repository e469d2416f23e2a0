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

/// Of a scene in space and its loads. kMirror: the mesh is the half y >= 0 (makeHalfSceneMesh), the tip moves in the
/// plane y = 0; forces and stiffness are still those of the whole cell (zero across the
/// plane). States that break the symmetry are not seen.
enum class Symmetry { kNone, kMirror };

/// A scene on a mesh: everything in it, in space (Dim 3) or, on the axis, in its section (Dim 2). Keeps its state and
/// continues from it. One thread at a time.
template <int Dim>
class CellProblem {
 public:
  /// Throws std::invalid_argument when the needle's disc and the holding pipette overlap, or when what is to be
  /// mirrored is not the half y >= 0 of a mesh in space with the needle's place in y = 0.
  CellProblem(const Scene& scene, QuadraticMesh<Dim> mesh, ElementKind element, Symmetry symmetry = Symmetry::kNone);

  /// Equilibrium with the tip displaced by this (m) from where it touches the undeformed cell, reached along the
  /// straight line from the present one at constant speed in `duration` (s; infinite: nothing viscous resists). On
  /// failure the state stays at the last equilibrium that was found. A section takes displacements along z only.
  IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                            double duration = std::numeric_limits<double>::infinity());

  /// Back to the undeformed state.
  void reset() { path_->reset(); }

  const LayeredBody<Dim>& body() const { return *body_; }
  const Eigen::VectorXd& state() const { return path_->state(); }  ///< see LayeredBody
  const Eigen::Vector3d& tipDisplacement() const { return path_->translation(); }
  int unknowns() const { return system_->freeSize(); }

 private:
  Constraints constraints(const Scene& scene) const;
  void addContact(const Scene& scene, EquilibriumSystem::Terms& terms);
  static LoadPathConfig pathConfig(const Scene& scene, bool linear);

  Symmetry symmetry_;
  std::shared_ptr<LayeredBody<Dim>> body_;
  std::shared_ptr<TipContact<Dim>> contact_;  ///< of a rounded tip
  double deepest_ = 0;                        ///< m, that it may enter the surface
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
};

}  // namespace microinjection
