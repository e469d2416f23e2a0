#include "cell/mechanics/reference_element.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "cell/mesh/quadratic_mesh.h"
#include "cell/mesh/round_shapes.h"

namespace microinjection {
namespace {

/// Integral of prod x_i^power_i over the reference simplex.
double monomialIntegral(const std::vector<int>& powers) {
  double numerator = 1, sum = static_cast<double>(powers.size());
  for (int power : powers) {
    numerator *= std::tgamma(power + 1.0);
    sum += power;
  }
  return numerator / std::tgamma(sum + 1);
}

/// All powers of `size` coordinates of a degree up to `degree`.
std::vector<std::vector<int>> powersUpTo(int size, int degree) {
  std::vector<std::vector<int>> all = {{}};
  for (int i = 0; i < size; ++i) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& powers : all) {
      int used = 0;
      for (int power : powers) used += power;
      for (int power = 0; used + power <= degree; ++power) {
        longer.push_back(powers);
        longer.back().push_back(power);
      }
    }
    all = longer;
  }
  return all;
}

/// Largest error of the rule, relative to the integral, over monomials up to `degree`.
double quadratureError(const ReferenceElement& element, int size, int degree) {
  double worst = 0;
  for (const std::vector<int>& powers : powersUpTo(size, degree)) {
    double sum = 0;
    for (const ReferenceElement::Point& point : element.points) {
      double value = point.weight;
      for (int i = 0; i < size; ++i) value *= std::pow(point.barycentric[i + 1], powers[i]);
      sum += value;
    }
    worst = std::max(worst, std::abs(sum / monomialIntegral(powers) - 1));
  }
  return worst;
}

/// Reference coordinates of a quadratic simplex' nodes, as columns.
Eigen::MatrixXd quadraticNodes(int size, const std::vector<std::array<int, 2>>& edges) {
  Eigen::MatrixXd nodes = Eigen::MatrixXd::Zero(size, size + 1 + static_cast<int>(edges.size()));
  nodes.block(0, 1, size, size).setIdentity();
  int next = size + 1;
  for (const auto& [a, b] : edges) nodes.col(next++) = (nodes.col(a) + nodes.col(b)) / 2;
  return nodes;
}

/// Shape functions interpolate each polynomial up to their degree exactly, as do their gradients.
void expectInterpolates(const ReferenceElement::Point& point, const Eigen::VectorXd& shape,
                        const Eigen::MatrixXd& gradient, const Eigen::MatrixXd& nodes, int degree) {
  const int size = static_cast<int>(nodes.rows());
  ASSERT_EQ(shape.size(), nodes.cols());
  ASSERT_EQ(gradient.rows(), nodes.cols());
  ASSERT_EQ(gradient.cols(), size);
  const Eigen::VectorXd at = point.barycentric.tail(size);
  for (const std::vector<int>& powers : powersUpTo(size, degree)) {
    const auto monomial = [&](const Eigen::VectorXd& x, int derivative) {
      double value = 1;
      for (int i = 0; i < size; ++i) {
        const int lower = derivative == i ? 1 : 0;
        value *= powers[i] < lower ? 0 : std::pow(x[i], powers[i] - lower) * (lower ? powers[i] : 1);
      }
      return value;
    };
    Eigen::VectorXd nodal(nodes.cols());
    for (int a = 0; a < nodes.cols(); ++a) nodal[a] = monomial(nodes.col(a), -1);
    EXPECT_NEAR(shape.dot(nodal), monomial(at, -1), 1e-14);
    for (int i = 0; i < size; ++i) EXPECT_NEAR(gradient.col(i).dot(nodal), monomial(at, i), 1e-14);
  }
}

template <int Dim>
void expectRightElement(ElementKind kind, int degree) {
  SCOPED_TRACE(elementName(kind) + " in " + std::to_string(Dim) + " dimensions");
  const ReferenceElement& element = referenceElement<Dim>(kind);
  EXPECT_LT(quadratureError(element, Dim, degree), 1e-13);
  EXPECT_GT(quadratureError(element, Dim, degree + 1), 1e-4);
  const Eigen::MatrixXd quadratic = quadraticNodes(Dim, elementEdges<Dim>());
  const Eigen::MatrixXd linear = quadratic.leftCols(Dim + 1);
  for (const ReferenceElement::Point& point : element.points) {
    EXPECT_GE(point.barycentric.minCoeff(), 0);
    EXPECT_NEAR(point.barycentric.sum(), 1, 1e-14);
    ASSERT_EQ(element.nodes, point.shape.size());
    expectInterpolates(point, point.map, point.map_gradient, isQuadratic(kind) ? quadratic : linear,
                       isQuadratic(kind) ? 2 : 1);
    if (kind == ElementKind::kMini) {
      expectInterpolates(point, point.shape.head(Dim + 1), point.gradient.topRows(Dim + 1), linear, 1);
    } else {
      EXPECT_EQ(point.shape, point.map);
      EXPECT_EQ(point.gradient, point.map_gradient);
    }
  }
}

TEST(ReferenceElement, RulesAreExactToTheirDegreeAndShapesInterpolate) {
  for (const std::string& name : elementNames()) {
    const ElementKind kind = elementKind(name);
    expectRightElement<2>(kind, 4);
    expectRightElement<3>(kind, kind == ElementKind::kMini ? 5 : 2);
  }
}

template <int Dim>
void expectRightBubble() {
  SCOPED_TRACE(Dim);
  double integral = 0;
  Eigen::Matrix<double, Dim, 1> slope = Eigen::Matrix<double, Dim, 1>::Zero();
  double moment = 0;
  for (const ReferenceElement::Point& point : referenceElement<Dim>(ElementKind::kMini).points) {
    EXPECT_GT(point.shape[Dim + 1], 0);
    EXPECT_LE(point.shape[Dim + 1], 1);
    integral += point.weight * point.shape[Dim + 1];
    slope += point.weight * point.gradient.row(Dim + 1).transpose();
    moment += point.weight * point.gradient.row(Dim + 1).dot(point.barycentric.tail(Dim));
  }
  // (Dim+1)^(Dim+1) times the product of all barycentric coordinates; by parts, since it vanishes on the boundary.
  const double expected = std::pow(Dim + 1, Dim + 1) / std::tgamma(2 * Dim + 2);
  EXPECT_NEAR(integral, expected, 1e-13);
  EXPECT_LT(slope.norm(), 1e-13);
  EXPECT_NEAR(moment, -Dim * expected, 1e-13);
}

TEST(ReferenceElement, TheBubbleIsOneAtTheCentroidAndZeroOnTheBoundary) {
  expectRightBubble<2>();
  expectRightBubble<3>();
}

TEST(ReferenceElement, FacetsAreExactToTheirDegreeAndInterpolate) {
  EXPECT_LT(quadratureError(referenceFacet<2>(), 1, 5), 1e-13);
  EXPECT_LT(quadratureError(referenceFacet<3>(), 2, 4), 1e-13);
  const Eigen::MatrixXd edge = quadraticNodes(1, {{0, 1}});
  const Eigen::MatrixXd triangle = quadraticNodes(2, {{0, 1}, {1, 2}, {0, 2}});
  for (const ReferenceElement::Point& point : referenceFacet<2>().points) {
    expectInterpolates(point, point.shape, point.gradient, edge, 2);
    EXPECT_EQ(point.map, point.shape);
  }
  for (const ReferenceElement::Point& point : referenceFacet<3>().points) {
    expectInterpolates(point, point.shape, point.gradient, triangle, 2);
    EXPECT_EQ(point.map, point.shape);
  }
}

TEST(ReferenceElement, NodesAreThoseOfTheMesh) {
  EXPECT_EQ(elementEdges<2>().size() + 3, static_cast<std::size_t>(QuadraticMesh<2>::kNodes));
  EXPECT_EQ(elementEdges<3>().size() + 4, static_cast<std::size_t>(QuadraticMesh<3>::kNodes));
  EXPECT_EQ(referenceElement<2>(ElementKind::kP2).nodes, QuadraticMesh<2>::kNodes);
  EXPECT_EQ(referenceElement<3>(ElementKind::kP2).nodes, QuadraticMesh<3>::kNodes);
  EXPECT_EQ(referenceFacet<2>().nodes, QuadraticMesh<2>::kFacetNodes);
  EXPECT_EQ(referenceFacet<3>().nodes, QuadraticMesh<3>::kFacetNodes);
}

/// Volume of the map of all elements, of the whole body of revolution in a section.
template <int Dim>
double mappedVolume(const QuadraticMesh<Dim>& mesh, ElementKind kind) {
  double volume = 0;
  for (const auto& nodes : mesh.elements) {
    for (const ReferenceElement::Point& at : referenceElement<Dim>(kind).points) {
      Eigen::Matrix<double, Dim, 1> x = Eigen::Matrix<double, Dim, 1>::Zero();
      Eigen::Matrix<double, Dim, Dim> jacobian = Eigen::Matrix<double, Dim, Dim>::Zero();
      for (int a = 0; a < at.map.size(); ++a) {
        x += at.map[a] * mesh.nodes[nodes[a]];
        jacobian += mesh.nodes[nodes[a]] * at.map_gradient.row(a);
      }
      EXPECT_GT(jacobian.determinant(), 0);
      volume += at.weight * jacobian.determinant() * (Dim == 2 ? 2 * M_PI * x[0] : 1);
    }
  }
  return volume;
}

/// Relative error of the volume of a ball of two layers on three meshes, edges halved each time.
template <int Dim>
std::array<double, 3> volumeErrors(ElementKind kind) {
  const std::vector<double> radii = {1.3, 0.8};  // m
  const double exact = 4.0 / 3 * M_PI * std::pow(radii[0], 3);
  std::array<double, 3> errors;
  for (int i = 0; i < 3; ++i) {
    double volume = 0;
    if constexpr (Dim == 2) {
      volume = mappedVolume(makeQuadratic(layeredHalfDisc(8 << i, radii), radii), kind);
    } else {
      volume = mappedVolume(makeQuadratic(layeredBall(1 + i, radii), radii), kind);
    }
    errors[i] = std::abs(volume / exact - 1);
  }
  return errors;
}

template <int Dim>
void expectVolumeConverges(ElementKind kind, double order, double coarsest) {
  SCOPED_TRACE(elementName(kind) + " in " + std::to_string(Dim) + " dimensions");
  const std::array<double, 3> errors = volumeErrors<Dim>(kind);
  EXPECT_LT(errors[0], coarsest);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), order, 0.3) << errors[i];
}

TEST(ReferenceElement, VolumeOfABallConvergesWithFourthOrderWhenCurvedAndSecondWhenStraight) {
  expectVolumeConverges<2>(ElementKind::kP1, 2, 0.1);
  expectVolumeConverges<2>(ElementKind::kP2, 4, 1e-3);
  expectVolumeConverges<3>(ElementKind::kP1, 2, 0.3);
  expectVolumeConverges<3>(ElementKind::kP2, 4, 0.02);
}

}  // namespace
}  // namespace microinjection
