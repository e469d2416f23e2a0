#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/material/lame.h"
#include "cell/mechanics/tetrahedron_kernel.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Internal force of a homogeneous St-Venant-Kirchhoff body on P1 tetrahedra, as an explicit scheme wants it: nothing
/// but the force, at nanoseconds a tetrahedron (`./dev bench speed_error`). Of each element
///
///     F = I + du/dX,   E = (F^T F - I) / 2,   S = lambda tr(E) I + 2 mu E,   P = F S,   f_a = -V P grad N_a:
///
/// equations (11) and (12) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted biological
/// cell injection", whose polynomial in the vertices' displacements is the same force multiplied out. The sign is that
/// of the body's force on its vertices, -dW/dx. The same as LayeredBody<3> with kP1 and StVenantKirchhoff but for
/// rounding, which depends on the instruction set. An inverted element has the force that the formulas give it.
///
/// Elements are sorted and vertices renumbered along a space-filling curve. One thread at a time.
class StVenantKirchhoffForce {
 public:
  /// For the instruction set, or the machine's best. Throws std::invalid_argument for a mesh with a vertex that is not
  /// finite or a tetrahedron that names a vertex that is not there, is flat or is inverted, a modulus that is not
  /// mu > 0 and 3 lambda + 2 mu > 0, or an instruction set that this machine does not have.
  StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame);
  StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame, InstructionSet set);

  /// `positions` of the deformed body's vertices, m, xyz per vertex in the mesh's order; `forces`, N, in the same order
  /// (zero for a vertex of no tetrahedron). They may not overlap. Allocates nothing.
  void evaluate(const double* positions, double* forces);

  std::size_t vertexCount() const { return order_.size(); }
  InstructionSet instructionSet() const { return set_; }

 private:
  InstructionSet set_;
  TetrahedronKernel kernel_;
  double ratio_;            ///< lambda / (2 mu)
  std::vector<int> order_;  ///< the mesh's number of each vertex here
  std::vector<TetrahedronBlock> blocks_;
  std::vector<PaddedVector> positions_, forces_;
};

}  // namespace microinjection
