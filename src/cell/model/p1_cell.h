#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cell/mechanics/layered_body.h"
#include "cell/mesh/tet_mesh.h"
#include "cell/model/disc_contact_cell.h"

namespace microinjection {

/// The undeformed cell of a scene on linear (P1) tetrahedra: mesh, elasticity of each layer, held
/// vertices and contact queries. Vertices on the surface with z < 0 within contact_radius of the z
/// axis stick to the holding pipette and are held.
class P1Cell : public DiscContactCell, public std::enable_shared_from_this<P1Cell> {
 public:
  /// Meshes the cell or reads its mesh from the cache (see cell/mesh/mesh_cache.h). Throws
  /// ConfigError when the scene is not valid or needs more than these elements can do (see
  /// refusals), std::runtime_error when meshing fails.
  explicit P1Cell(const Scene& scene);

  /// Features of the scene that this model lacks: a rounded tip, surface tension, viscoelasticity,
  /// struts and cables; empty if there are none.
  static std::vector<std::string> refusals(const Scene& scene);

  const TetMesh& mesh() const { return mesh_; }
  /// Shared by the systems of equations of many threads, because it has no history, see
  /// LayeredBody.
  const std::shared_ptr<LayeredBody<3>>& body() const { return body_; }

  std::string description() const override;
  std::unique_ptr<TipPath> path(const ContactPoint& contact_point) const override;  ///< @pre owned by a shared_ptr

 private:
  TetMesh mesh_;
  std::shared_ptr<LayeredBody<3>> body_;
};

}  // namespace microinjection
