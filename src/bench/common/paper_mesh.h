#pragma once

#include <memory>
#include <vector>

#include "cell/scene.h"
#include "mechanics/load_path.h"
#include "mesh/tet_mesh.h"

namespace microinjection {

/// A mesh of about the size of one of Table III of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for
/// assisted biological cell injection", whose meshes are not published.
struct PaperMesh {
  std::size_t vertices, tetrahedra;  ///< the paper's
  double size;                       ///< m, of the largest elements
  double density;                    ///< how many times smaller at the needle
  bool circles;  ///< as the live cell's: edges follow the tip's and the pipette's circle, which takes 250 vertices
};

const std::vector<PaperMesh>& paperMeshes();

/// Linear tetrahedra of a scene with a disc, its sticking vertices found as the live cell finds them.
struct P1Cell {
  TetMesh mesh;
  std::vector<int> tip, held;
};

P1Cell makeP1Cell(const Scene& scene, const PaperMesh& mesh);

/// Quasi-static P1 of a scene's outermost material, with the live cell's solver (cell/indentation.h) on any P1Cell.
class P1QuasiStatic {
 public:
  P1QuasiStatic(const Scene& scene, const P1Cell& cell);

  /// N, of the cell on the needle, along z; nan where no equilibrium was found.
  double force(double depth);

 private:
  std::unique_ptr<EquilibriumSystem> system_;
  std::unique_ptr<LoadPath> path_;
};

}  // namespace microinjection
