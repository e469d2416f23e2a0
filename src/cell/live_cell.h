#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/cell_under_needle.h"
#include "cell/scene.h"
#include "contact/ray_cast.h"
#include "contact/tip_patch.h"
#include "mesh/surface_mesh.h"

namespace microinjection {

/// The cell at rest under a needle tip.
struct IndentationSolution {
  bool converged = false;
  std::string reason;                                          ///< why not, for people; empty when converged
  Eigen::Vector3d tip_displacement = Eigen::Vector3d::Zero();  ///< m, reached: the one asked for when converged
  Eigen::Vector3d force = Eigen::Vector3d::Zero();             ///< N, of the cell on the needle, at tip_displacement
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< N/m, d(force)/d(tip_displacement) = -stiffness; symmetric
  double smallest_jacobian = 1;                         ///< det F of the element that is compressed most
  int newton_iterations = 0;
  double cpu_time = 0;  ///< s, of the calling thread
};

/// A cell under one sticking patch: every vertex of the patch moves by the displacement of the tip. Keeps its state and
/// continues from it, so a needle that moves little costs little. One thread at a time.
class LiveIndentation {
 public:
  virtual ~LiveIndentation() = default;

  /// Equilibrium at `tip_displacement` (m), reached along the straight line from the present one in adaptive load
  /// steps, in `duration` (s; infinite: nothing viscous resists). On failure the state stays at the last equilibrium
  /// that was found.
  virtual IndentationSolution solve(const Eigen::Vector3d& tip_displacement,
                                    double duration = std::numeric_limits<double>::infinity()) = 0;

  /// Displacement, m, xyz per vertex of the mesh that SurfaceMesh::mesh_vertices and TipPatch::vertices number.
  virtual Eigen::VectorXd displacement() const = 0;

  /// Struts and cables, where the cell has some.
  virtual std::vector<CellUnderNeedle::Member> members() const { return {}; }

  /// Displacement of the tip in the present state, m.
  virtual Eigen::Vector3d tipDisplacement() const = 0;

  /// Back to the cell without the needle.
  virtual void reset() = 0;
};

/// A cell that a moving needle meets on its surface and that is solved while it moves. Centre at the origin, metres.
/// Immutable after construction and safe to share between threads.
class LiveCell {
 public:
  virtual ~LiveCell() = default;

  const Scene& scene() const { return scene_; }
  const SurfaceMesh& surface() const { return surface_; }

  /// Vertices of the mesh that are held.
  const std::vector<int>& heldVertices() const { return held_vertices_; }

  /// First intersection of a ray with the surface at rest. `start`, a triangle hit before, makes the search local.
  std::optional<SurfaceHit> hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, int start = 0) const {
    return castRayFrom(surface_, start, origin, direction);
  }

  /// What sticks to the tip of a needle whose line goes through `point` along `axis`, which points out of the cell;
  /// see findTipPatch.
  TipPatch patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const {
    return findTipPatch(surface_, point, axis, scene_.needle.tip.radius);
  }

  /// Throws std::invalid_argument when the patch and the held vertices overlap or leave nothing free.
  virtual std::unique_ptr<LiveIndentation> indentation(const TipPatch& patch) const = 0;

  /// Struts and cables without the needle, where the cell has some.
  virtual std::vector<CellUnderNeedle::Member> membersAtRest() const { return {}; }

 protected:
  explicit LiveCell(const Scene& scene) : scene_(scene) {}

  Scene scene_;
  SurfaceMesh surface_;
  std::vector<int> held_vertices_;
};

}  // namespace microinjection
