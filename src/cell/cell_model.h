#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/live_cell.h"
#include "mechanics/layered_body.h"
#include "mesh/tet_mesh.h"

namespace microinjection {

/// The cell that a scene describes, undeformed, on linear (P1) tetrahedra: mesh, elasticity of each layer, held
/// vertices and contact queries. Held are the vertices stuck to the holding pipette: on the surface, z < 0, within
/// contact_radius of the z axis.
class CellModel : public LiveCell, public std::enable_shared_from_this<CellModel> {
 public:
  /// Meshes the cell or takes its mesh from the cache (see mesh/mesh_cache.h). Throws ConfigError when the scene is
  /// not valid or has what these elements cannot do in time (a rounded tip, surface tension, viscoelasticity),
  /// std::runtime_error when meshing fails.
  explicit CellModel(const Scene& scene);

  const TetMesh& mesh() const { return mesh_; }
  /// To be shared by the systems of equations of many threads: it remembers nothing, see LayeredBody.
  const std::shared_ptr<LayeredBody<3>>& body() const { return body_; }

  /// @pre owned by a std::shared_ptr.
  std::unique_ptr<LiveIndentation> indentation(const TipPatch& patch) const override;

 private:
  TetMesh mesh_;
  std::shared_ptr<LayeredBody<3>> body_;
};

}  // namespace microinjection
