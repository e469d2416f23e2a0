#include "cell/mechanics/reference_element.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {
namespace {

struct Rule {
  std::vector<Eigen::VectorXd> barycentric;
  std::vector<double> weights;  ///< sum to 1

  /// Adds all permutations of a barycentric point, each with this weight.
  void add(std::vector<double> point, double weight) {
    std::sort(point.begin(), point.end());
    do {
      barycentric.push_back(Eigen::Map<Eigen::VectorXd>(point.data(), point.size()));
      weights.push_back(weight);
    } while (std::next_permutation(point.begin(), point.end()));
  }
};

/// Gauss-Legendre with three points, degree 5.
Rule edgeRule() {
  const double x = std::sqrt(0.15);
  Rule rule;
  rule.add({0.5 - x, 0.5 + x}, 5.0 / 18);
  rule.barycentric.push_back(Eigen::Vector2d(0.5, 0.5));
  rule.weights.push_back(4.0 / 9);
  return rule;
}

/// Degree 4 (Dunavant 1985).
Rule triangleRule() {
  constexpr double a = 0.445948490915965, b = 0.091576213509771;
  Rule rule;
  rule.add({a, a, 1 - 2 * a}, 0.223381589678011);
  rule.add({b, b, 1 - 2 * b}, 0.109951743655322);
  return rule;
}

/// Degree 2.
Rule tetrahedronRule() {
  const double a = (5 - std::sqrt(5.0)) / 20;
  Rule rule;
  rule.add({a, a, a, 1 - 3 * a}, 0.25);
  return rule;
}

/// Degree 5 (Walkington 2000).
Rule fineTetrahedronRule() {
  constexpr double a = 0.31088591926330060980, b = 0.092735250310891226402, c = 0.045503704125649649492;
  Rule rule;
  rule.add({a, a, a, 1 - 3 * a}, 0.11268792571801585080);
  rule.add({b, b, b, 1 - 3 * b}, 0.073493043116361949544);
  rule.add({c, c, 0.5 - c, 0.5 - c}, 0.042546020777081466438);
  return rule;
}

/// d(barycentric)/d(reference coordinates): corner 0 at the origin, corner i at the end of axis i.
template <int Dim>
Eigen::Matrix<double, Dim + 1, Dim> barycentricGradient() {
  Eigen::Matrix<double, Dim + 1, Dim> gradient;
  gradient.row(0).setConstant(-1);
  gradient.template bottomRows<Dim>().setIdentity();
  return gradient;
}

template <int Dim>
void linearShape(const Eigen::VectorXd& l, Eigen::VectorXd& shape, Eigen::MatrixXd& gradient) {
  shape = l;
  gradient = barycentricGradient<Dim>();
}

template <int Dim>
void bubbleShape(const Eigen::VectorXd& l, Eigen::VectorXd& shape, Eigen::MatrixXd& gradient) {
  const double scale = std::pow(Dim + 1, Dim + 1);  // one at the centroid
  const auto dl = barycentricGradient<Dim>();
  shape.resize(Dim + 2);
  gradient.resize(Dim + 2, Dim);
  shape.head(Dim + 1) = l;
  gradient.topRows(Dim + 1) = dl;
  shape[Dim + 1] = scale * l.prod();
  gradient.row(Dim + 1).setZero();
  for (int i = 0; i <= Dim; ++i) {
    double others = scale;
    for (int j = 0; j <= Dim; ++j) others *= j == i ? 1 : l[j];
    gradient.row(Dim + 1) += others * dl.row(i);
  }
}

template <int Dim>
void quadraticShape(const Eigen::VectorXd& l, const std::vector<std::array<int, 2>>& edges, Eigen::VectorXd& shape,
                    Eigen::MatrixXd& gradient) {
  const auto dl = barycentricGradient<Dim>();
  shape.resize(Dim + 1 + edges.size());
  gradient.resize(shape.size(), Dim);
  for (int i = 0; i <= Dim; ++i) {
    shape[i] = l[i] * (2 * l[i] - 1);
    gradient.row(i) = (4 * l[i] - 1) * dl.row(i);
  }
  int next = Dim + 1;
  for (const auto& [a, b] : edges) {
    shape[next] = 4 * l[a] * l[b];
    gradient.row(next++) = 4 * (l[a] * dl.row(b) + l[b] * dl.row(a));
  }
}

template <int Dim>
ReferenceElement make(ElementKind kind) {
  const Rule rule = Dim == 2 ? triangleRule() : kind == ElementKind::kMini ? fineTetrahedronRule() : tetrahedronRule();
  const double volume = Dim == 2 ? 0.5 : 1.0 / 6;
  ReferenceElement element;
  for (std::size_t i = 0; i < rule.weights.size(); ++i) {
    ReferenceElement::Point point;
    const Eigen::VectorXd& l = rule.barycentric[i];
    point.weight = volume * rule.weights[i];
    point.barycentric = l;
    linearShape<Dim>(l, point.map, point.map_gradient);
    if (kind == ElementKind::kMini) {
      bubbleShape<Dim>(l, point.shape, point.gradient);
    } else if (isQuadratic(kind)) {
      quadraticShape<Dim>(l, elementEdges<Dim>(), point.shape, point.gradient);
      point.map = point.shape;
      point.map_gradient = point.gradient;
    } else {
      linearShape<Dim>(l, point.shape, point.gradient);
    }
    element.points.push_back(point);
  }
  element.nodes = static_cast<int>(element.points[0].shape.size());
  return element;
}

template <int FacetDim>
ReferenceElement makeFacet(const Rule& rule, const std::vector<std::array<int, 2>>& edges) {
  ReferenceElement facet;
  for (std::size_t i = 0; i < rule.weights.size(); ++i) {
    ReferenceElement::Point point;
    point.weight = rule.weights[i] / FacetDim;  // edge: 1, triangle: 1/2
    point.barycentric = rule.barycentric[i];
    quadraticShape<FacetDim>(rule.barycentric[i], edges, point.shape, point.gradient);
    point.map = point.shape;
    point.map_gradient = point.gradient;
    facet.points.push_back(point);
  }
  facet.nodes = static_cast<int>(facet.points[0].shape.size());
  return facet;
}

}  // namespace

const std::vector<std::string>& elementNames() {
  static const std::vector<std::string> names = {"p1", "mini", "p1_p1", "p2", "p2_p0", "p2_p1"};
  return names;
}

ElementKind elementKind(const std::string& name) {
  const auto& names = elementNames();
  return static_cast<ElementKind>(std::find(names.begin(), names.end(), name) - names.begin());
}

const std::string& elementName(ElementKind kind) { return elementNames()[static_cast<int>(kind)]; }

bool hasContinuousPressure(ElementKind kind) {
  return kind == ElementKind::kMini || kind == ElementKind::kP1P1 || kind == ElementKind::kP2P1;
}

bool isQuadratic(ElementKind kind) {
  return kind == ElementKind::kP2 || kind == ElementKind::kP2P0 || kind == ElementKind::kP2P1;
}

template <int Dim>
const ReferenceElement& referenceElement(ElementKind kind) {
  static const std::map<ElementKind, ReferenceElement> elements = [] {
    std::map<ElementKind, ReferenceElement> all;
    for (const std::string& name : elementNames()) all[elementKind(name)] = make<Dim>(elementKind(name));
    return all;
  }();
  return elements.at(kind);
}

template <>
const ReferenceElement& referenceFacet<2>() {
  static const ReferenceElement facet = makeFacet<1>(edgeRule(), {{0, 1}});
  return facet;
}

template <>
const ReferenceElement& referenceFacet<3>() {
  static const ReferenceElement facet = makeFacet<2>(triangleRule(), {{0, 1}, {1, 2}, {0, 2}});
  return facet;
}

template const ReferenceElement& referenceElement<2>(ElementKind);
template const ReferenceElement& referenceElement<3>(ElementKind);

}  // namespace microinjection
