#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "cell/material/lame.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// The tensors of one P1 tetrahedron, its corners i, j, k, l = 0..3: the coefficients of the energy
///
///     W = 1/2 u_i . K_ij u_j + 1/2 (C_ijk . u_i) (u_j . u_k) + 1/2 D_ijkl (u_i . u_j) (u_k . u_l)
///
/// (summed over all corners) of a St-Venant-Kirchhoff body; a linear body has the first term only.
/// With the gradients g_i of the shape functions and the undeformed volume V
///
///     K_ij   = V (lambda g_i g_j^T + mu g_j g_i^T + mu (g_i . g_j) I)
///     C_ijk  = V (lambda g_i (g_j . g_k) + mu g_j (g_i . g_k) + mu g_k (g_i . g_j))
///     D_ijkl = V/4 (lambda (g_i . g_j) (g_k . g_l) + mu (g_i . g_k) (g_j . g_l)
///                    + mu (g_i . g_l) (g_j . g_k))
///
/// K is equation (7) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted
/// biological cell injection", after correction: with m_i = -6 V g_i, the outward normal of the
/// face opposite to corner i, of *twice its area* (printed: "unit"), K_ij = (lambda m_i m_j^T + mu
/// m_j m_i^T + mu (m_i . m_j) I) / (36 V). The printed first line ends with the end of the second,
/// which is one term of mu too many and closes the bracket too early. The paper does not give C and
/// D; with these its equation (11) is the energy's derivative.
struct TetrahedronTensors {
  Eigen::Matrix<double, 3, 4> gradients;  ///< g_i in the columns, 1/m
  double volume;                          ///< m^3
  Lame lame;

  /// @pre the tetrahedron is positively oriented
  TetrahedronTensors(const TetMesh& mesh, std::size_t tetrahedron, const Lame& moduli);

  Eigen::Matrix3d K(int i, int j) const;         ///< N/m; K_ji = K_ij^T
  Eigen::Vector3d C(int i, int j, int k) const;  ///< N/m^2; C_ijk = C_ikj
  double D(int i, int j, int k, int l) const;    ///< N/m^3; D_ijkl = D_jikl = D_klij
};

/// Internal force of P1 tetrahedra from precomputed tensors: equations (6), (8), (11) and (12) of
/// the paper,
///
///     f_i = K_ij u_j + (C_jki . u_j) u_k + 1/2 C_ijk (u_j . u_k) + 2 D_jkli (u_j . u_k) u_l,
///
/// over all corners j, k, l of each tetrahedron (printed: from 1 to 4 in two sums, from 0 to 3 in
/// the third); a linear body has the first term only. Tensors summed over one index vanish, because
/// a translation gives no force. Displacements relative to the first corner and the tensors of the
/// other three therefore suffice: 144 numbers a tetrahedron (linear: 54).
///
/// The force is that of StVenantKirchhoffForce in expanded form. That class is faster (`./dev
/// paper` measures by how much): it reads 7 numbers a tetrahedron.
class TensorMassForce {
 public:
  enum class Kind { kLinear, kStVenantKirchhoff };

  /// Throws as checkP1Body.
  TensorMassForce(const TetMesh& mesh, const Lame& lame, Kind kind);

  /// `displacements`, m, xyz per vertex; `forces` of the body on its vertices, -dW/du, N, in the
  /// same order (the paper's F_int has the opposite sign). They must not overlap. Does not
  /// allocate.
  void evaluate(const double* displacements, double* forces) const;

  std::size_t vertexCount() const { return vertex_count_; }
  std::size_t tensorBytes() const;  ///< of all tensors

 private:
  static constexpr int kPairs = 6;  ///< of corners 1 to 3, in either order: 11, 22, 33, 12, 13, 23
  struct Linear {
    double K[kPairs][9];  ///< by columns; K_ji is the transpose of K_ij
  };
  struct Higher {
    double C[3][kPairs][3];    ///< C_ijk of corner i and pair jk
    double D[kPairs][kPairs];  ///< 2 D_ijkl of pairs ij and kl; twice that if k and l differ
  };
  static Linear linear(const TetrahedronTensors& tensors);
  static Higher higher(const TetrahedronTensors& tensors);
  static void addLinear(const Linear& tensors, const double (*d)[3], double (*f)[3]);
  static void addHigher(const Higher& tensors, const double (*d)[3], double (*f)[3]);

  std::size_t vertex_count_;
  std::vector<std::array<int, 4>> corners_;
  std::vector<Linear> linear_;
  std::vector<Higher> higher_;  ///< none for a linear body
};

}  // namespace microinjection
