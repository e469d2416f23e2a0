#include "cell/mechanics/layered_body.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "cell/mechanics/element_sum.h"

namespace microinjection {
namespace {

constexpr std::size_t kMostPoints = 14;

/// mu, Pa: derivative of the stress by simple shear in the undeformed material.
double shearModulus(const Material& material) {
  return material.distortionalTangent(Eigen::Matrix3d::Identity())(3, 3);
}

/// A linear displacement has a constant F in a tetrahedron, so that one point suffices. In a
/// section the hoop strain varies.
template <int Dim>
std::vector<ReferenceElement::Point> quadrature(ElementKind kind) {
  std::vector<ReferenceElement::Point> points = referenceElement<Dim>(kind).points;
  if (Dim == 3 && kind == ElementKind::kP1) {
    for (std::size_t q = 1; q < points.size(); ++q) points[0].weight += points[q].weight;
    points.resize(1);
  }
  if (points.size() > kMostPoints) throw std::logic_error("a rule of more points than LayeredBody has room for");
  return points;
}

}  // namespace

template <int Dim>
LayeredBody<Dim>::LayeredBody(QuadraticMesh<Dim> mesh, ElementKind kind, Materials materials, Inversion inversion)
    : mesh_(std::move(mesh)), kind_(kind), materials_(std::move(materials)), inversion_(inversion) {
  const int elements = static_cast<int>(mesh_.elements.size());
  nodes_of_element_ = referenceElement<Dim>(kind).nodes;
  node_count_ = isQuadratic(kind) ? static_cast<int>(mesh_.nodes.size())
                                  : mesh_.vertex_count + (kind == ElementKind::kMini ? elements : 0);
  const bool constant_pressure = kind == ElementKind::kP2P0;
  pressure_count_ = constant_pressure ? elements : hasContinuousPressure(kind) ? mesh_.vertex_count : 0;
  const std::vector<ReferenceElement::Point> points = quadrature<Dim>(kind);
  point_count_ = static_cast<int>(points.size());
  for (const ReferenceElement::Point& point : points) {
    pressure_shape_.push_back(constant_pressure ? Eigen::VectorXd(Eigen::VectorXd::Ones(1)) : point.barycentric);
  }
  entries_.reserve(elements);
  weights_.reserve(elements * points.size());
  derivatives_.reserve(elements * points.size() * 3 * nodes_of_element_);
  for (int e = 0; e < elements; ++e) addElement(e, points);

  double stiffest = 0;
  for (const auto& material : materials_) {
    stiffest = std::max(stiffest, shearModulus(*material));
  }
  pressure_unit_ = stiffest / std::cbrt(volume() / elements);
}

template <int Dim>
void LayeredBody<Dim>::addElement(int index, const std::vector<ReferenceElement::Point>& points) {
  const auto& nodes = mesh_.elements[index];
  const int layer = mesh_.layers[index];
  if (layer < 0 || layer >= static_cast<int>(materials_.size())) {
    throw InvertedElement("element " + std::to_string(index) + " is of layer " + std::to_string(layer) +
                          ", which has no material");
  }
  std::vector<int> entries;
  for (int k = 0; k < Dim; ++k) {
    for (int a = 0; a < nodes_of_element_; ++a) {
      const bool bubble = kind_ == ElementKind::kMini && a == Dim + 1;
      entries.push_back(Dim * (bubble ? mesh_.vertex_count + index : nodes[a]) + k);
    }
  }
  if (kind_ == ElementKind::kP2P0) entries.push_back(Dim * node_count_ + index);
  for (int a = 0; hasContinuousPressure(kind_) && a <= Dim; ++a) entries.push_back(Dim * node_count_ + nodes[a]);
  entries_.push_back(std::move(entries));
  for (const ReferenceElement::Point& at : points) {
    Eigen::Matrix<double, Dim, 1> x = Eigen::Matrix<double, Dim, 1>::Zero();
    Eigen::Matrix<double, Dim, Dim> jacobian = Eigen::Matrix<double, Dim, Dim>::Zero();
    for (int a = 0; a < at.map.size(); ++a) {
      x += at.map[a] * mesh_.nodes[nodes[a]];
      jacobian += mesh_.nodes[nodes[a]] * at.map_gradient.row(a);
    }
    const double determinant = jacobian.determinant();
    if (!(determinant > 0)) {
      throw InvertedElement("element " + std::to_string(index) + " is not positively oriented");
    }
    weights_.push_back(at.weight * determinant * (Dim == 2 ? 2 * M_PI * x[0] : 1));
    Eigen::Matrix<double, Eigen::Dynamic, 3> derivatives(nodes_of_element_, 3);
    derivatives.template leftCols<Dim>() = at.gradient * jacobian.inverse();
    if (Dim == 2) derivatives.col(2) = at.shape / x[0];
    derivatives_.insert(derivatives_.end(), derivatives.data(), derivatives.data() + derivatives.size());
  }
}

template <int Dim>
bool LayeredBody<Dim>::isLinear() const {
  return std::all_of(materials_.begin(), materials_.end(), [](const auto& material) { return material->isLinear(); });
}

template <int Dim>
template <int N>
Eigen::Matrix<double, N, Dim> LayeredBody<Dim>::displacement(int element, const Eigen::VectorXd& state) const {
  Eigen::Matrix<double, N, Dim> u;
  const int* entries = entries_[element].data();
  for (int i = 0; i < N * Dim; ++i) u.data()[i] = state[entries[i]];
  return u;
}

template <int Dim>
bool LayeredBody<Dim>::evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  return withNodes([&](auto nodes) { return evaluateNodes<decltype(nodes)::value>(element, state, order, result); });
}

template <int Dim>
template <int N>
bool LayeredBody<Dim>::evaluateNodes(int element, const Eigen::VectorXd& state, Order order,
                                     LocalEnergy& result) const {
  const Material& material = *materials_[mesh_.layers[element]];
  const bool any_volume = material.isLinear() || (inversion_ == Inversion::kAllowed && !material.resistsInversion());
  const Eigen::Matrix<double, N, Dim> u = displacement<N>(element, state);
  Material::Kinematics at[kMostPoints];
  for (int q = 0; q < point_count_; ++q) {
    const Eigen::Matrix3d F = Strain<Dim>::deformationGradient(u, derivatives<N>(element, q));
    if (!any_volume && !(F.determinant() > 0)) return false;
    at[q] = material.kinematics(F);
  }
  ElementSum<Dim, N> sum(material, order, result);
  if (kind_ == ElementKind::kP1 || kind_ == ElementKind::kP2) {
    for (int q = 0; q < point_count_; ++q) {
      sum.add(at[q], material.whole(), derivatives<N>(element, q), weight(element, q));
    }
    sum.finish(N * Dim);
  } else if (kind_ == ElementKind::kP2P0) {
    addPressure<N, 1>(element, at, state, sum, result);
  } else {
    addPressure<N, Dim + 1>(element, at, state, sum, result);
  }
  return std::isfinite(result.energy);
}

/// Adds the terms of a mixed element: M = 1 pressure of the element, or one of each corner.
template <int Dim>
template <int N, int M>
void LayeredBody<Dim>::addPressure(int element, const Material::Kinematics* at, const Eigen::VectorXd& state,
                                   ElementSum<Dim, N>& sum, LocalEnergy& result) const {
  using Pressures = Eigen::Matrix<double, M, 1>;
  using Sum = ElementSum<Dim, N>;
  const Material& material = sum.material();
  const double kappa = material.dilatationalModulus();
  const double mu = kind_ == ElementKind::kP1P1 ? shearModulus(material) : 0;
  Pressures nodal, residual = Pressures::Zero();
  for (int a = 0; a < M; ++a) nodal[a] = pressure_unit_ * state[entries_[element][N * Dim + a]];
  Eigen::Matrix<double, N * Dim, M> coupling = Eigen::Matrix<double, N * Dim, M>::Zero();
  Eigen::Matrix<double, M, M> compliance = Eigen::Matrix<double, M, M>::Zero();
  for (int q = 0; q < point_count_; ++q) {
    const double volume = weight(element, q);
    const Pressures shape = pressure_shape_[q];
    sum.add(at[q], Material::mixed(1, shape.dot(nodal)), derivatives<N>(element, q), volume);
    residual += volume * at[q].dilatation * shape;
    compliance += (volume / kappa) * shape * shape.transpose();
    if (mu > 0) {
      const Pressures fluctuation = shape - Pressures::Constant(1.0 / M);
      compliance += (volume / mu) * fluctuation * fluctuation.transpose();
    }
    if (sum.order() != Order::kHessian) continue;
    const typename Sum::Nodal c = Sum::project(at[q].dilatation_gradient, derivatives<N>(element, q));
    coupling += (volume * Eigen::Map<const typename Sum::Vector>(c.data())) * shape.transpose();
  }
  result.energy -= 0.5 * nodal.dot(compliance * nodal);
  sum.finish(N * Dim + M);
  if (sum.order() == Order::kEnergy) return;
  result.gradient.tail(M) = pressure_unit_ * (residual - compliance * nodal);
  if (sum.order() != Order::kHessian) return;
  result.hessian.topRightCorner(N * Dim, M) = pressure_unit_ * coupling;
  result.hessian.bottomLeftCorner(M, N * Dim) = pressure_unit_ * coupling.transpose();
  result.hessian.bottomRightCorner(M, M) = -pressure_unit_ * pressure_unit_ * compliance;
}

template <int Dim>
Eigen::Matrix3d LayeredBody<Dim>::deformationGradient(int element, int point, const Eigen::VectorXd& state) const {
  return withNodes([&](auto nodes) {
    constexpr int N = decltype(nodes)::value;
    return Strain<Dim>::deformationGradient(displacement<N>(element, state), derivatives<N>(element, point));
  });
}

template <int Dim>
double LayeredBody<Dim>::smallestJacobian(const Eigen::VectorXd& state) const {
  double smallest = std::numeric_limits<double>::infinity();
  for (int e = 0; e < elementCount(); ++e) {
    for (int q = 0; q < point_count_; ++q) {
      smallest = std::min(smallest, deformationGradient(e, q, state).determinant());
    }
  }
  return smallest;
}

template <int Dim>
double LayeredBody<Dim>::volume() const {
  double volume = 0;
  for (double weight : weights_) volume += weight;
  return volume;
}

template class LayeredBody<2>;
template class LayeredBody<3>;

}  // namespace microinjection
