#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "material/material.h"
#include "mesh/tet_mesh.h"

namespace microinjection {

/// Finite elements of a hyperelastic body: one linear (P1) displacement per tetrahedron, hence one deformation
/// gradient. Displacements `u` and forces are vectors of 3 numbers per vertex, xyz, in metres and newtons. Immutable,
/// safe to share between threads.
class ElasticBody {
 public:
  using ElementMatrix = Eigen::Matrix<double, 12, 12>;

  /// Throws std::invalid_argument when an element is not positively oriented.
  ElasticBody(const TetMesh& mesh, std::unique_ptr<const Material> material);

  const Material& material() const { return *material_; }
  int vertexCount() const { return vertex_count_; }
  int elementCount() const { return static_cast<int>(elements_.size()); }
  const std::array<int, 4>& corners(int element) const { return elements_[element].corners; }

  /// F = I + grad u of an element.
  Eigen::Matrix3d deformationGradient(int element, const Eigen::VectorXd& u) const;

  /// det F of the element where it is smallest.
  double smallestJacobian(const Eigen::VectorXd& u) const;

  /// Strain energy, J; +infinity when the material is not defined at some F.
  double energy(const Eigen::VectorXd& u) const;

  /// Derivative of the energy: the forces that hold the body in this shape. Resizes `force` when needed.
  /// @pre energy(u) is finite.
  void internalForce(const Eigen::VectorXd& u, Eigen::VectorXd& force) const;

  /// Second derivative of an element's energy with respect to its corners' displacements, N/m.
  void elementStiffness(int element, const Eigen::VectorXd& u, ElementMatrix& stiffness) const;

 private:
  struct Element {
    std::array<int, 4> corners;
    Eigen::Matrix<double, 3, 4> gradients;  ///< of the shape functions, 1/m
    double volume;                          ///< m^3
  };

  int vertex_count_;
  std::vector<Element> elements_;
  std::unique_ptr<const Material> material_;
};

}  // namespace microinjection
