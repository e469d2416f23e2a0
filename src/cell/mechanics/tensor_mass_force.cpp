#include "cell/mechanics/tensor_mass_force.h"

#include <algorithm>

#include "cell/mechanics/p1_body.h"

namespace microinjection {
namespace {

constexpr int kFirst[] = {0, 1, 2, 0, 0, 1}, kSecond[] = {0, 1, 2, 1, 2, 2};  ///< corners (less one) of each pair
constexpr int kPairOf[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

TetrahedronTensors::TetrahedronTensors(const TetMesh& mesh, std::size_t tetrahedron, const Lame& moduli)
    : gradients(shapeGradients(mesh, tetrahedron)),
      volume(tetrahedronVolume(mesh, static_cast<int>(tetrahedron))),
      lame(moduli) {}

Eigen::Matrix3d TetrahedronTensors::K(int i, int j) const {
  const auto& g = gradients;
  const double shear = volume * lame.mu * g.col(i).dot(g.col(j));
  return volume * lame.lambda * g.col(i) * g.col(j).transpose() + volume * lame.mu * g.col(j) * g.col(i).transpose() +
         shear * Eigen::Matrix3d::Identity();
}

Eigen::Vector3d TetrahedronTensors::C(int i, int j, int k) const {
  const auto& g = gradients;
  return volume * (lame.lambda * g.col(j).dot(g.col(k)) * g.col(i) + lame.mu * g.col(i).dot(g.col(k)) * g.col(j) +
                   lame.mu * g.col(i).dot(g.col(j)) * g.col(k));
}

double TetrahedronTensors::D(int i, int j, int k, int l) const {
  const auto& g = gradients;
  const auto product = [&](int a, int b) { return g.col(a).dot(g.col(b)); };
  return volume / 4 *
         (lame.lambda * product(i, j) * product(k, l) +
          lame.mu * (product(i, k) * product(j, l) + product(i, l) * product(j, k)));
}

TensorMassForce::TensorMassForce(const TetMesh& mesh, const Lame& lame, Kind kind)
    : vertex_count_(mesh.vertices.size()), corners_(mesh.tetrahedra) {
  checkP1Body(mesh, lame);
  linear_.reserve(corners_.size());
  if (kind == Kind::kStVenantKirchhoff) higher_.reserve(corners_.size());
  for (std::size_t t = 0; t < corners_.size(); ++t) {
    const TetrahedronTensors tensors(mesh, t, lame);
    linear_.push_back(linear(tensors));
    if (kind == Kind::kStVenantKirchhoff) higher_.push_back(higher(tensors));
  }
}

TensorMassForce::Linear TensorMassForce::linear(const TetrahedronTensors& tensors) {
  Linear result;
  for (int p = 0; p < kPairs; ++p) {
    Eigen::Map<Eigen::Matrix3d>(result.K[p]) = tensors.K(kFirst[p] + 1, kSecond[p] + 1);
  }
  return result;
}

TensorMassForce::Higher TensorMassForce::higher(const TetrahedronTensors& tensors) {
  Higher result;
  for (int p = 0; p < kPairs; ++p) {
    const int j = kFirst[p] + 1, k = kSecond[p] + 1;
    for (int i = 0; i < 3; ++i) Eigen::Map<Eigen::Vector3d>(result.C[i][p]) = tensors.C(i + 1, j, k);
    for (int q = 0; q < kPairs; ++q) {
      const double orders = kFirst[q] == kSecond[q] ? 1 : 2;
      result.D[p][q] = 2 * orders * tensors.D(j, k, kFirst[q] + 1, kSecond[q] + 1);
    }
  }
  return result;
}

/// f += K d
void TensorMassForce::addLinear(const Linear& tensors, const double (*d)[3], double (*f)[3]) {
  for (int p = 0; p < kPairs; ++p) {
    const double* K = tensors.K[p];
    const int i = kFirst[p], j = kSecond[p];
    for (int r = 0; r < 3; ++r) f[i][r] += K[r] * d[j][0] + K[3 + r] * d[j][1] + K[6 + r] * d[j][2];
    if (i == j) continue;
    for (int r = 0; r < 3; ++r) f[j][r] += dot(K + 3 * r, d[i]);
  }
}

/// f_i += 1/2 C_ijk s_jk + (C_jki . d_j + 2 D_jkli s_jl) d_k with s_jk = d_j . d_k. The second
/// bracket is a scalar for each pair of corners.
void TensorMassForce::addHigher(const Higher& tensors, const double (*d)[3], double (*f)[3]) {
  double s[kPairs], weighted[kPairs], along[kPairs];
  for (int p = 0; p < kPairs; ++p) {
    s[p] = dot(d[kFirst[p]], d[kSecond[p]]);
    weighted[p] = p < 3 ? s[p] / 2 : s[p];
  }
  for (int p = 0; p < kPairs; ++p) {
    along[p] = dot(tensors.C[0][p], d[0]) + dot(tensors.C[1][p], d[1]) + dot(tensors.C[2][p], d[2]);
    for (int q = 0; q < kPairs; ++q) along[p] += tensors.D[p][q] * s[q];
  }
  for (int i = 0; i < 3; ++i) {
    for (int p = 0; p < kPairs; ++p) {
      for (int r = 0; r < 3; ++r) f[i][r] += weighted[p] * tensors.C[i][p][r];
    }
    for (int k = 0; k < 3; ++k) {
      for (int r = 0; r < 3; ++r) f[i][r] += along[kPairOf[i][k]] * d[k][r];
    }
  }
}

void TensorMassForce::evaluate(const double* displacements, double* forces) const {
  std::fill_n(forces, 3 * vertex_count_, 0.0);
  for (std::size_t t = 0; t < corners_.size(); ++t) {
    const auto& corner = corners_[t];
    const double* origin = displacements + 3 * corner[0];
    double d[3][3], f[3][3] = {};
    for (int a = 0; a < 3; ++a) {
      for (int r = 0; r < 3; ++r) d[a][r] = displacements[3 * corner[a + 1] + r] - origin[r];
    }
    addLinear(linear_[t], d, f);
    if (!higher_.empty()) addHigher(higher_[t], d, f);
    for (int r = 0; r < 3; ++r) {
      forces[3 * corner[0] + r] += f[0][r] + f[1][r] + f[2][r];
      for (int a = 0; a < 3; ++a) forces[3 * corner[a + 1] + r] -= f[a][r];
    }
  }
}

std::size_t TensorMassForce::tensorBytes() const {
  return linear_.size() * sizeof(Linear) + higher_.size() * sizeof(Higher);
}

}  // namespace microinjection
