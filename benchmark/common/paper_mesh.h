#pragma once

#include <memory>
#include <vector>

#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/load_path.h"
#include "cell/mesh/tet_mesh.h"
#include "cell/model/scene.h"

namespace microinjection {

/// A mesh within 5 % of the size of one of Table III of Ladjal, Hanus, Ferreira, "Micro-to-nano
/// biomechanical modeling for assisted biological cell injection", whose meshes are not published.
/// Refined as the paper has it: about the needle, in a ball of five needle diameters, elements are
/// five times smaller than the largest.
struct PaperMesh {
  std::size_t vertices, tetrahedra;  ///< the paper's
  double size;                       ///< m, of the largest elements that are asked for
  double growth;                     ///< of the size with the distance from the needle, see CellMeshConfig
  bool circles;  ///< as the live cell's: edges follow the tip's and the pipette's circle; the coarsest have no room
  double stretch = 1;  ///< see CellMeshConfig
};

/// All twelve rows.
const std::vector<PaperMesh>& paperMeshes();

/// Linear tetrahedra of a scene with a disc, its sticking vertices found as the live cell finds
/// them; held by three at least.
struct PaperCell {
  TetMesh mesh;
  std::vector<int> tip, held;
};

PaperCell makePaperCell(const Scene& scene, const PaperMesh& mesh);

/// Quasi-static P1 of a scene's outermost material, with the live cell's solver
/// (cell/model/indentation.h) on any PaperCell.
class P1QuasiStatic {
 public:
  P1QuasiStatic(const Scene& scene, const PaperCell& cell);

  /// N, of the cell on the needle, along z; nan where no equilibrium was found.
  double force(double depth);

  /// det F of the flattest element, in the last equilibrium.
  double smallestJacobian() const { return body_->smallestJacobian(path_->state()); }

 private:
  std::shared_ptr<LayeredBody<3>> body_;
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
};

}  // namespace microinjection
