#pragma once

#include <Eigen/Core>
#include <array>

#include "cell/material/material.h"
#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Deformation gradient F of displacements, in space (Dim = 3: components x, y, z) or of a body of
/// revolution without twist (Dim = 2: components r, z; F in the directions r, theta, z). A node's
/// row of derivatives has its shape function's derivatives by x, y, z, or by r and z and the shape
/// function over r for the hoop strain; 1/m.
template <int Dim>
struct Strain {
  /// Component of F (column-major, i + 3 J) to which derivative m of displacement component k
  /// contributes; -1: none.
  static constexpr int component(int k, int m) {
    constexpr int kSpace[3][3] = {{0, 3, 6}, {1, 4, 7}, {2, 5, 8}};
    constexpr int kSection[2][3] = {{0, 6, 4}, {2, 8, -1}};
    return Dim == 3 ? kSpace[k][m] : kSection[k % 2][m];
  }

  /// The three of nine values that belong to displacement component k.
  static Eigen::Vector3d pick(const double* values, int k) {
    Eigen::Vector3d result;
    for (int m = 0; m < 3; ++m) result[m] = component(k, m) < 0 ? 0 : values[component(k, m)];
    return result;
  }

  /// The block of a 9 x 9 tangent between displacement components k and l.
  static Eigen::Matrix3d pick(const Material::Matrix9d& tangent, int k, int l) {
    Eigen::Matrix3d result;
    for (int n = 0; n < 3; ++n) {
      for (int m = 0; m < 3; ++m) {
        const int row = component(k, m), column = component(l, n);
        result(m, n) = row < 0 || column < 0 ? 0 : tangent(row, column);
      }
    }
    return result;
  }

  /// F from the nodes' displacements (nodes x Dim).
  template <typename Nodal, typename Derivatives>
  static Eigen::Matrix3d deformationGradient(const Nodal& displacement, const Derivatives& derivatives) {
    const Eigen::Matrix<double, 3, Dim> gradient = derivatives.transpose().lazyProduct(displacement);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int k = 0; k < Dim; ++k) {
      for (int m = 0; m < 3; ++m) {
        if (component(k, m) >= 0) F.data()[component(k, m)] += gradient(m, k);
      }
    }
    return F;
  }
};

/// Sums one element's energy of N nodes and its derivatives over quadrature points.
template <int Dim, int N>
class ElementSum {
 public:
  using Nodal = Eigen::Matrix<double, N, Dim>;
  using Derivatives = Eigen::Map<const Eigen::Matrix<double, N, 3>>;
  using Vector = Eigen::Matrix<double, N * Dim, 1>;  ///< of the element's displacements, component by component

  ElementSum(const Material& material, Order order, LocalEnergy& result)
      : material_(material), order_(order), result_(result) {
    result_.zero = false;
    result_.energy = 0;
    force_.setZero();
    if (order_ != Order::kHessian) return;
    for (int k = 0; k < Dim; ++k) {
      for (int l = 0; l <= k; ++l) stiffness_[k][l].setZero();
    }
  }

  const Material& material() const { return material_; }
  Order order() const { return order_; }

  /// `weight`: m^3
  void add(const Material::Kinematics& kinematics, const Material::Weights& parts, const Derivatives& derivatives,
           double weight) {
    add([&] { return material_.energyDensity(kinematics, parts); }, [&] { return material_.stress(kinematics, parts); },
        [&] { return material_.tangent(kinematics, parts); }, derivatives, weight);
  }

  /// Adds an energy density, J/m^3, with its derivatives by F. The functions have no arguments and
  /// are called only up to the derivative that `order` needs.
  template <typename Energy, typename Stress, typename Tangent>
  void add(const Energy& energy, const Stress& stress, const Tangent& tangent_of, const Derivatives& derivatives,
           double weight) {
    result_.energy += weight * energy();
    if (order_ == Order::kEnergy) return;
    force_ += weight * project(stress(), derivatives);
    if (order_ != Order::kHessian) return;
    const Material::Matrix9d tangent = tangent_of();
    for (int k = 0; k < Dim; ++k) {
      for (int l = 0; l <= k; ++l) {
        const Eigen::Matrix3d block = weight * Strain<Dim>::pick(tangent, k, l);
        const Eigen::Matrix<double, N, 3> left = derivatives.lazyProduct(block);
        stiffness_[k][l] += left.lazyProduct(derivatives.transpose());
      }
    }
  }

  /// Derivative of stress : F by the nodes' displacements.
  static Nodal project(const Eigen::Matrix3d& stress, const Derivatives& derivatives) {
    Nodal result;
    for (int k = 0; k < Dim; ++k) {
      result.col(k) = derivatives.lazyProduct(Strain<Dim>::pick(stress.data(), k));
    }
    return result;
  }

  /// Writes the sums to the head of the result's derivatives, which get `size` entries.
  void finish(int size) {
    if (order_ == Order::kEnergy) return;
    result_.gradient.setZero(size);
    result_.gradient.template head<N * Dim>() = Eigen::Map<const Vector>(force_.data());
    if (order_ != Order::kHessian) return;
    result_.hessian.setZero(size, size);
    for (int k = 0; k < Dim; ++k) {
      for (int l = 0; l <= k; ++l) {
        result_.hessian.template block<N, N>(k * N, l * N) = stiffness_[k][l];
        if (l < k) result_.hessian.template block<N, N>(l * N, k * N) = stiffness_[k][l].transpose();
      }
    }
  }

 private:
  const Material& material_;
  Order order_;
  LocalEnergy& result_;
  Nodal force_;
  std::array<std::array<Eigen::Matrix<double, N, N>, Dim>, Dim> stiffness_;  ///< below the diagonal, by components
};

}  // namespace microinjection
