#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/material/lame.h"
#include "cell/mechanics/tetrahedron_kernel.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Internal force of a homogeneous St-Venant-Kirchhoff body on P1 tetrahedra for explicit schemes:
/// it computes only the force, in nanoseconds per tetrahedron (`./dev bench speed_error`). For each
/// element
///
///     F = I + du/dX,   E = (F^T F - I) / 2,   S = lambda tr(E) I + 2 mu E,
///     P = F S,   f_a = -V P grad N_a:
///
/// equations (11) and (12) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for
/// assisted biological cell injection", whose polynomial in the vertices' displacements is the
/// expanded form of the same force. The sign is that of the body's force on its vertices, -dW/dx.
/// It equals LayeredBody<3> with kP1 and StVenantKirchhoff except for rounding, which depends on
/// the instruction set. An inverted element has the force that the formulas give.
///
/// Elements are sorted and vertices renumbered along a space-filling curve. One thread at a time.
class StVenantKirchhoffForce {
 public:
  /// For the given instruction set, or the best of this machine. Throws std::invalid_argument as
  /// checkP1Body does, or when this machine lacks the instruction set.
  StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame);
  StVenantKirchhoffForce(const TetMesh& mesh, const Lame& lame, InstructionSet set);

  /// `positions` of the deformed body's vertices, m, xyz per vertex in the mesh's order; `forces`,
  /// N, in the same order (zero for a vertex without tetrahedron). They must not overlap. Does not
  /// allocate.
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
