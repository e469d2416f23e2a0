#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace microinjection {

/// Eight P1 tetrahedra of a total-Lagrangian St-Venant-Kirchhoff body, as its force's inner loop takes them. Edges of
/// the undeformed element, from its first vertex, are the columns of Q R: Q turns the reference frame (to which an
/// isotropic energy is blind), U = R^-1 is upper triangular, so that F Q = [d1 d2 d3] U with the deformed edges d.
struct alignas(64) TetrahedronBlock {
  static constexpr int kSize = 8;
  double inverse[6][kSize] = {};        ///< 1/m: U11, U12, U13, U22, U23, U33; zero for one that is not there
  double weight[kSize] = {};            ///< J: mu V; zero for one that is not there
  std::uint32_t vertex[kSize][4] = {};  ///< four times its number
};

/// Three coordinates of a vertex and one that is not used.
struct alignas(32) PaddedVector {
  double value[4] = {};
};

/// What a kernel was compiled for; all are in every program, the machine's are called.
enum class InstructionSet {
  kBaseline,  ///< of the platform (SSE2 on x86-64)
  kAvx2,      ///< AVX2 and FMA
  kAvx512     ///< AVX-512 F, VL, DQ: same width as AVX2 (four tetrahedra), twice the registers
};

/// sse2, avx2, avx512; baseline on other processors.
std::string instructionSetName(InstructionSet set);

/// That this machine can run, the best last.
std::vector<InstructionSet> supportedInstructionSets();

/// forces[v] -= dW/dx_v of all blocks, N. For each element, C = F^T F, S / mu = ratio tr(C - I) I + C - I with ratio =
/// lambda / (2 mu), P = F S and forces V P U^T on the far ends of its edges, their sum with the other sign on the first
/// vertex. Works on positions, so that what cancels is of 1e-16 / strain.
using TetrahedronKernel = void (*)(const TetrahedronBlock* blocks, std::size_t count, double ratio,
                                   const PaddedVector* positions, PaddedVector* forces);

/// @pre this machine supports the set
TetrahedronKernel tetrahedronKernel(InstructionSet set);

}  // namespace microinjection
