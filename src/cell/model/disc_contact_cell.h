#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "cell/contact/ray_cast.h"
#include "cell/contact/tip_patch.h"
#include "cell/mesh/surface_mesh.h"
#include "cell/model/live_cell.h"
#include "cell/model/scene.h"

namespace microinjection {

/// A live cell with a surface of triangles and a disc tip. Vertices under the disc stick to it.
class DiscContactCell : public LiveCell {
 public:
  const Scene& scene() const override { return scene_; }
  const SurfaceMesh& surface() const { return surface_; }  ///< at rest; mesh_vertices ascend

  /// Vertices of the mesh that are held, numbered as SurfaceMesh::mesh_vertices and
  /// TipPatch::vertices.
  const std::vector<int>& heldVertices() const { return held_vertices_; }

  /// First intersection of a ray with the surface at rest. `start`, a triangle of an earlier hit,
  /// makes the search local.
  std::optional<SurfaceHit> hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, int start = 0) const;

  /// Vertices that stick to a tip whose line passes through `point` along `axis`, which points out
  /// of the cell; see findTipPatch.
  TipPatch patchAt(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) const;

  const char* refusal(const Eigen::Vector3d& /*axis*/) const override { return nullptr; }
  std::optional<Eigen::Vector3d> touch(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                       int& hint) const override;
  bool isClear(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
               const Eigen::Vector3d& contact_point) const override;
  ContactPoint contactAt(const Eigen::Vector3d& contact_point, const Eigen::Vector3d& axis) const override;
  Eigen::Vector3d preparedDisplacement() const override { return Eigen::Vector3d::Zero(); }
  Surface undeformedSurface() const override;
  std::vector<std::uint32_t> onSurface(const TipPatch& patch) const override;

 protected:
  /// Derived classes fill the surface and the held vertices.
  explicit DiscContactCell(const Scene& scene) : scene_(scene) {}

  Scene scene_;
  SurfaceMesh surface_;
  std::vector<int> held_vertices_;
};

}  // namespace microinjection
