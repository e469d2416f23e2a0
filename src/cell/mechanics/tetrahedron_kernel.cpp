#include "cell/mechanics/tetrahedron_kernel.h"

// Compiled with -O3 -ffp-contract=fast (src/CMakeLists.txt). All code here is inlined into the
// functions at the end of the file and compiled for their instruction sets. It must not use the
// standard library: the linker might keep a copy of an inline function that was compiled for a
// newer processor.
#define MICROINJECTION_INLINE static inline __attribute__((always_inline))

#if defined(__clang__) || __GNUC__ >= 12
#define MICROINJECTION_MIX(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define MICROINJECTION_MIX(a, b, i, j, k, l) __builtin_shuffle(a, b, Lanes{i, j, k, l})
#endif

namespace microinjection {
namespace {

/// Columns of V P from those of F. Value: a number of one element, or of each of four.
template <typename Value>
MICROINJECTION_INLINE void stress(const Value (*F)[3], const Value& weight, double ratio, Value (*P)[3]) {
  Value s11 = F[0][0] * F[0][0] + F[0][1] * F[0][1] + F[0][2] * F[0][2] - 1;
  Value s22 = F[1][0] * F[1][0] + F[1][1] * F[1][1] + F[1][2] * F[1][2] - 1;
  Value s33 = F[2][0] * F[2][0] + F[2][1] * F[2][1] + F[2][2] * F[2][2] - 1;
  const Value volumetric = ratio * (s11 + s22 + s33);
  s11 = weight * (s11 + volumetric);
  s22 = weight * (s22 + volumetric);
  s33 = weight * (s33 + volumetric);
  const Value s12 = weight * (F[0][0] * F[1][0] + F[0][1] * F[1][1] + F[0][2] * F[1][2]);
  const Value s13 = weight * (F[0][0] * F[2][0] + F[0][1] * F[2][1] + F[0][2] * F[2][2]);
  const Value s23 = weight * (F[1][0] * F[2][0] + F[1][1] * F[2][1] + F[1][2] * F[2][2]);
  for (int k = 0; k < 3; ++k) {
    P[0][k] = F[0][k] * s11 + F[1][k] * s12 + F[2][k] * s13;
    P[1][k] = F[0][k] * s12 + F[1][k] * s22 + F[2][k] * s23;
    P[2][k] = F[0][k] * s13 + F[1][k] * s23 + F[2][k] * s33;
  }
}

/// h[a]: x, y, z of V P U^T of edge a, from the edges d[a]. Stored: type of Value in a block's
/// arrays.
template <typename Value, typename Stored>
MICROINJECTION_INLINE void edgeForces(const TetrahedronBlock& block, int first, double ratio, const Value (*d)[3],
                                      Value (*h)[3]) {
  Value u[6], F[3][3], P[3][3];
  for (int k = 0; k < 6; ++k) u[k] = *reinterpret_cast<const Stored*>(block.inverse[k] + first);
  for (int k = 0; k < 3; ++k) {
    F[0][k] = d[0][k] * u[0];
    F[1][k] = d[0][k] * u[1] + d[1][k] * u[3];
    F[2][k] = d[0][k] * u[2] + d[1][k] * u[4] + d[2][k] * u[5];
  }
  const Value weight = *reinterpret_cast<const Stored*>(block.weight + first);
  stress<Value>(F, weight, ratio, P);
  for (int k = 0; k < 3; ++k) {
    h[0][k] = P[0][k] * u[0] + P[1][k] * u[1] + P[2][k] * u[2];
    h[1][k] = P[1][k] * u[3] + P[2][k] * u[4];
    h[2][k] = P[2][k] * u[5];
  }
}

/// Handles one element at a time, for any processor.
void addBaseline(const TetrahedronBlock* __restrict blocks, std::size_t count, double ratio,
                 const PaddedVector* __restrict positions, PaddedVector* __restrict forces) {
  const double* x = reinterpret_cast<const double*>(positions);
  double* f = reinterpret_cast<double*>(forces);
  for (std::size_t i = 0; i < count * TetrahedronBlock::kSize; ++i) {
    const TetrahedronBlock& block = blocks[i / TetrahedronBlock::kSize];
    const int at = static_cast<int>(i % TetrahedronBlock::kSize);
    const std::uint32_t* vertex = block.vertex[at];
    double d[3][3], h[3][3];
    for (int a = 0; a < 3; ++a) {
      for (int k = 0; k < 3; ++k) d[a][k] = x[vertex[a + 1] + k] - x[vertex[0] + k];
    }
    edgeForces<double, double>(block, at, ratio, d, h);
    for (int k = 0; k < 3; ++k) {
      f[vertex[0] + k] += h[0][k] + h[1][k] + h[2][k];
      for (int a = 0; a < 3; ++a) f[vertex[a + 1] + k] -= h[a][k];
    }
  }
}

#ifdef __x86_64__
/// One number of four tetrahedra, or the coordinates of one vertex, in the compilers' vector type.
using Four = double __attribute__((vector_size(32)));
using FourInMemory = double __attribute__((vector_size(32), aligned(32), may_alias));
using Lanes = long long __attribute__((vector_size(32)));

MICROINJECTION_INLINE const FourInMemory& at(const double* values) {
  return *reinterpret_cast<const FourInMemory*>(values);
}

MICROINJECTION_INLINE FourInMemory& at(double* values) { return *reinterpret_cast<FourInMemory*>(values); }

/// x, y, z of four vectors.
MICROINJECTION_INLINE void toLanes(const Four* vectors, Four* x) {
  const Four low = MICROINJECTION_MIX(vectors[0], vectors[1], 0, 4, 2, 6);
  const Four high = MICROINJECTION_MIX(vectors[0], vectors[1], 1, 5, 3, 7);
  const Four low2 = MICROINJECTION_MIX(vectors[2], vectors[3], 0, 4, 2, 6);
  const Four high2 = MICROINJECTION_MIX(vectors[2], vectors[3], 1, 5, 3, 7);
  x[0] = MICROINJECTION_MIX(low, low2, 0, 1, 4, 5);
  x[1] = MICROINJECTION_MIX(high, high2, 0, 1, 4, 5);
  x[2] = MICROINJECTION_MIX(low, low2, 2, 3, 6, 7);
}

MICROINJECTION_INLINE void fromLanes(const Four* x, Four* vectors) {
  const Four nothing = {0, 0, 0, 0};
  const Four low = MICROINJECTION_MIX(x[0], x[1], 0, 4, 2, 6);
  const Four high = MICROINJECTION_MIX(x[0], x[1], 1, 5, 3, 7);
  const Four low2 = MICROINJECTION_MIX(x[2], nothing, 0, 4, 2, 6);
  const Four high2 = MICROINJECTION_MIX(x[2], nothing, 1, 5, 3, 7);
  vectors[0] = MICROINJECTION_MIX(low, low2, 0, 1, 4, 5);
  vectors[1] = MICROINJECTION_MIX(high, high2, 0, 1, 4, 5);
  vectors[2] = MICROINJECTION_MIX(low, low2, 2, 3, 6, 7);
  vectors[3] = MICROINJECTION_MIX(high, high2, 2, 3, 6, 7);
}

/// Adds the forces directly to the vertices. Storing all elements' forces and gathering them by
/// vertex was slower: by a fifth at 400 to 25 k tetrahedra, and twice as slow at 100 k.
MICROINJECTION_INLINE void addFour(const TetrahedronBlock& block, int first, double ratio, const double* __restrict x,
                                   double* __restrict f) {
  const auto& vertex = block.vertex;
  Four edge[3][4], d[3][3], h[3][3], force[3][4];
  for (int i = 0; i < 4; ++i) {
    const Four origin = at(x + vertex[first + i][0]);
    for (int a = 0; a < 3; ++a) edge[a][i] = at(x + vertex[first + i][a + 1]) - origin;
  }
  for (int a = 0; a < 3; ++a) toLanes(edge[a], d[a]);
  edgeForces<Four, FourInMemory>(block, first, ratio, d, h);
  for (int a = 0; a < 3; ++a) fromLanes(h[a], force[a]);
  for (int i = 0; i < 4; ++i) {
    at(f + vertex[first + i][0]) += force[0][i] + force[1][i] + force[2][i];
    for (int a = 0; a < 3; ++a) at(f + vertex[first + i][a + 1]) -= force[a][i];
  }
}

MICROINJECTION_INLINE void addAll(const TetrahedronBlock* __restrict blocks, std::size_t count, double ratio,
                                  const PaddedVector* __restrict positions, PaddedVector* __restrict forces) {
  const double* x = reinterpret_cast<const double*>(positions);
  double* f = reinterpret_cast<double*>(forces);
  for (std::size_t b = 0; b < count; ++b) {
    for (int first = 0; first < TetrahedronBlock::kSize; first += 4) {
      addFour(blocks[b], first, ratio, x, f);
    }
  }
}

__attribute__((target("avx2,fma"))) void addAvx2(const TetrahedronBlock* blocks, std::size_t count, double ratio,
                                                 const PaddedVector* positions, PaddedVector* forces) {
  addAll(blocks, count, ratio, positions, forces);
}

__attribute__((target("avx2,fma,avx512f,avx512vl,avx512dq"))) void addAvx512(const TetrahedronBlock* blocks,
                                                                             std::size_t count, double ratio,
                                                                             const PaddedVector* positions,
                                                                             PaddedVector* forces) {
  addAll(blocks, count, ratio, positions, forces);
}
#endif

}  // namespace

#ifdef __x86_64__
std::string instructionSetName(InstructionSet set) {
  return set == InstructionSet::kAvx512 ? "avx512" : set == InstructionSet::kAvx2 ? "avx2" : "sse2";
}

std::vector<InstructionSet> supportedInstructionSets() {
  std::vector<InstructionSet> sets = {InstructionSet::kBaseline};
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  // AVX2 comes last: on an AMD EPYC that has both, AVX-512 takes nearly twice as long (`bench
  // speed_error`).
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq")) {
    sets.push_back(InstructionSet::kAvx512);
  }
  if (avx2) sets.push_back(InstructionSet::kAvx2);
  return sets;
}

TetrahedronKernel tetrahedronKernel(InstructionSet set) {
  return set == InstructionSet::kAvx512 ? addAvx512 : set == InstructionSet::kAvx2 ? addAvx2 : addBaseline;
}
#else
std::string instructionSetName(InstructionSet /*set*/) { return "baseline"; }

std::vector<InstructionSet> supportedInstructionSets() { return {InstructionSet::kBaseline}; }

TetrahedronKernel tetrahedronKernel(InstructionSet /*set*/) { return addBaseline; }
#endif

}  // namespace microinjection
