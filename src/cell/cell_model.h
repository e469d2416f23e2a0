#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/live_cell.h"
#include "cell/scene.h"
#include "contact/ray_cast.h"
#include "contact/tip_patch.h"
#include "mechanics/layered_body.h"
#include "mesh/surface_mesh.h"
#include "mesh/tet_mesh.h"

namespace microinjection {

/// The cell that a scene describes, undeformed, on linear (P1) tetrahedra: mesh, elasticity of each layer, held
/// vertices and contact queries. Centre at the origin, metres. Immutable after construction and safe to share between
/// threads.
class CellModel : public LiveCell, public std::enable_shared_from_this<CellModel> {
 public:
  /// Meshes the cell or takes its mesh from the cache (see mesh/mesh_cache.h). Throws ConfigError when the scene is
  /// not valid or has what these elements cannot do (see refusals), std::runtime_error when meshing fails.
  explicit CellModel(const Scene& scene);

  /// What the scene has that this model does not: a rounded tip, surface tension, viscoelasticity; empty: nothing.
  static std::vector<std::string> refusals(const Scene& scene);

  const Scene& scene() const override { return scene_; }
  const TetMesh& mesh() const { return mesh_; }
  const SurfaceMesh& surface() const { return surface_; }
  /// To be shared by the systems of equations of many threads: it remembers nothing, see LayeredBody.
  const std::shared_ptr<LayeredBody<3>>& body() const { return body_; }

  /// Vertices of mesh() stuck to the holding pipette: on the surface, z < 0, within contact_radius of the z axis.
  const std::vector<int>& heldVertices() const { return held_vertices_; }

  /// First intersection of a ray with the undeformed surface. `start`, a triangle hit before, makes the search local.
  std::optional<SurfaceHit> hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, int start = 0) const;

  /// What sticks to the tip of a needle whose line goes through `point` along `axis`, which points out of the cell;
  /// see findTipPatch.
  TipPatch patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const;

  std::string description() const override;
  const char* refusal(const Eigen::Vector3d& /*axis*/) const override { return nullptr; }
  std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                       int& hint) const override;
  bool isOff(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, const Eigen::Vector3d& touched_at) const override;
  TipPlace placeAt(const Eigen::Vector3d& touched_at, const Eigen::Vector3d& axis) const override;
  Eigen::Vector3d preparedDisplacement() const override { return Eigen::Vector3d::Zero(); }
  std::unique_ptr<TipPath> path(const TipPlace& place) const override;  ///< @pre owned by a shared_ptr
  Surface surfaceAtRest() const override;
  std::vector<std::uint32_t> onSurface(const TipPatch& patch) const override;

 private:
  Scene scene_;
  TetMesh mesh_;
  SurfaceMesh surface_;
  std::vector<int> held_vertices_;
  std::shared_ptr<LayeredBody<3>> body_;
};

}  // namespace microinjection
