#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace microinjection {

/// Eight P1 tetrahedra of a total-Lagrangian St-Venant-Kirchhoff body, as the inner loop of its
/// force reads them. Edges of the undeformed element, from its first vertex, are the columns of Q
/// R. Q rotates the reference frame, on which an isotropic energy does not depend. U = R^-1 is
/// upper triangular, so that F Q = [d1 d2 d3] U with the deformed edges d.
struct alignas(64) TetrahedronBlock {
  static constexpr int kSize = 8;
  double inverse[6][kSize] = {};        ///< 1/m: U11, U12, U13, U22, U23, U33; zero in unused places
  double weight[kSize] = {};            ///< J: mu V; zero in unused places
  std::uint32_t vertex[kSize][4] = {};  ///< four times the vertex's number
};

/// Three coordinates of a vertex and one unused number.
struct alignas(32) PaddedVector {
  double value[4] = {};
};

/// Instruction set of a kernel. Every program contains all of them and calls the best that the
/// machine has.
enum class InstructionSet {
  kBaseline,  ///< of the platform (SSE2 on x86-64)
  kAvx2,      ///< AVX2 and FMA
  kAvx512     ///< AVX-512 F, VL, DQ: as wide as AVX2 (four tetrahedra), with twice the registers
};

/// sse2, avx2, avx512; baseline on other processors.
std::string instructionSetName(InstructionSet set);

/// Instruction sets that this machine has, the fastest last.
std::vector<InstructionSet> supportedInstructionSets();

/// forces[v] -= dW/dx_v of all blocks, N. For each element, C = F^T F, S / mu = ratio tr(C - I) I +
/// C - I with ratio = lambda / (2 mu), P = F S and forces V P U^T at the far ends of its edges; the
/// first vertex gets their negative sum. It works on positions, with a relative cancellation error
/// of 1e-16 / strain.
using TetrahedronKernel = void (*)(const TetrahedronBlock* blocks, std::size_t count, double ratio,
                                   const PaddedVector* positions, PaddedVector* forces);

/// @pre this machine supports the set
TetrahedronKernel tetrahedronKernel(InstructionSet set);

}  // namespace microinjection
