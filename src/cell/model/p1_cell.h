#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cell/mechanics/layered_body.h"
#include "cell/mesh/tet_mesh.h"
#include "cell/model/disc_contact_cell.h"

namespace microinjection {

/// The undeformed cell of a scene on linear (P1) tetrahedra, the paper's element (III.B, doc/reference/paper.md): mesh,
/// elasticity of each layer, held vertices and contact queries. Vertices on the surface with z < 0 within
/// contact_radius of the z axis stick to the holding pipette and are held.
///
/// P1 tetrahedra lock at the cell's Poisson's ratio of 0.49: the force to 10 um is 1.8 to 2.7 times the converged one
/// (doc/reference/benchmarks.md, Live cells). The class is kept as the live model of a disc all the same, since a
/// solution takes 20 to 50 ms and the needle may come from any direction, and as the mesh of ExplicitCellModel, which
/// reproduces the paper. It serves to look at a cell, not to measure its force.
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
