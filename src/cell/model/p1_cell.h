#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cell/mechanics/layered_body.h"
#include "cell/mesh/tet_mesh.h"
#include "cell/model/disc_contact_cell.h"

namespace microinjection {

/// The cell that a scene describes, undeformed, on linear (P1) tetrahedra: mesh, elasticity of each layer, held
/// vertices and contact queries. Held are the vertices stuck to the holding pipette: on the surface, z < 0, within
/// contact_radius of the z axis.
class P1Cell : public DiscContactCell, public std::enable_shared_from_this<P1Cell> {
 public:
  /// Meshes the cell or takes its mesh from the cache (see cell/mesh/mesh_cache.h). Throws ConfigError when the scene
  /// is not valid or has what these elements cannot do (see refusals), std::runtime_error when meshing fails.
  explicit P1Cell(const Scene& scene);

  /// What the scene has that this model does not: a rounded tip, surface tension, viscoelasticity,
  /// struts and cables; empty: nothing.
  static std::vector<std::string> refusals(const Scene& scene);

  const TetMesh& mesh() const { return mesh_; }
  /// To be shared by the systems of equations of many threads: it remembers nothing, see LayeredBody.
  const std::shared_ptr<LayeredBody<3>>& body() const { return body_; }

  std::string description() const override;
  std::unique_ptr<TipPath> path(const ContactPoint& place) const override;  ///< @pre owned by a shared_ptr

 private:
  TetMesh mesh_;
  std::shared_ptr<LayeredBody<3>> body_;
};

}  // namespace microinjection
