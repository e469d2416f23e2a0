#include "mechanics/elastic_body.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace microinjection {

ElasticBody::ElasticBody(const TetMesh& mesh, std::unique_ptr<const Material> material)
    : vertex_count_(static_cast<int>(mesh.vertices.size())), material_(std::move(material)) {
  elements_.reserve(mesh.tetrahedra.size());
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    Element element;
    element.corners = mesh.tetrahedra[t];
    element.volume = tetrahedronVolume(mesh, static_cast<int>(t));
    if (!(element.volume > 0)) throw std::invalid_argument("tetrahedron " + std::to_string(t) + " is inverted or flat");
    Eigen::Matrix3d edges;
    for (int i = 0; i < 3; ++i)
      edges.col(i) = mesh.vertices[element.corners[i + 1]] - mesh.vertices[element.corners[0]];
    element.gradients.rightCols<3>() = edges.inverse().transpose();
    element.gradients.col(0) = -element.gradients.rightCols<3>().rowwise().sum();
    elements_.push_back(element);
  }
}

Eigen::Matrix3d ElasticBody::deformationGradient(int element, const Eigen::VectorXd& u) const {
  const Element& e = elements_[element];
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  for (int a = 0; a < 4; ++a) F.noalias() += u.segment<3>(3 * e.corners[a]) * e.gradients.col(a).transpose();
  return F;
}

double ElasticBody::smallestJacobian(const Eigen::VectorXd& u) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int e = 0; e < elementCount(); ++e) smallest = std::min(smallest, deformationGradient(e, u).determinant());
  return smallest;
}

double ElasticBody::energy(const Eigen::VectorXd& u) const {
  double energy = 0;
  for (int e = 0; e < elementCount(); ++e) {
    energy += elements_[e].volume * material_->energyDensity(deformationGradient(e, u));
  }
  return energy;
}

void ElasticBody::internalForce(const Eigen::VectorXd& u, Eigen::VectorXd& force) const {
  force.setZero(3 * vertex_count_);
  for (int e = 0; e < elementCount(); ++e) {
    const Element& element = elements_[e];
    const Eigen::Matrix3d stress = element.volume * material_->stress(deformationGradient(e, u));
    for (int a = 0; a < 4; ++a) force.segment<3>(3 * element.corners[a]).noalias() += stress * element.gradients.col(a);
  }
}

void ElasticBody::elementStiffness(int element, const Eigen::VectorXd& u, ElementMatrix& stiffness) const {
  const Element& e = elements_[element];
  const Material::Matrix9d tangent = e.volume * material_->tangent(deformationGradient(element, u));
  // K_ab = sum over J, L of gradient_a[J] A_JL gradient_b[L], with A_JL the 3 x 3 blocks of the tangent.
  for (int a = 0; a < 4; ++a) {
    Eigen::Matrix<double, 3, 9> row = e.gradients(0, a) * tangent.topRows<3>();
    row += e.gradients(1, a) * tangent.middleRows<3>(3);
    row += e.gradients(2, a) * tangent.bottomRows<3>();
    for (int b = 0; b < 4; ++b) {
      stiffness.block<3, 3>(3 * a, 3 * b) = e.gradients(0, b) * row.leftCols<3>() +
                                            e.gradients(1, b) * row.middleCols<3>(3) +
                                            e.gradients(2, b) * row.rightCols<3>();
    }
  }
}

}  // namespace microinjection
