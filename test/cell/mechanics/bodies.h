#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mesh/round_shapes.h"
#include "cell/mesh/shapes.h"

namespace microinjection {

template <int Dim, ElementKind Kind>
struct ElementCase {
  static constexpr int kDim = Dim;
  static constexpr ElementKind kKind = Kind;
};

/// Every element in both dimensions, for typed tests.
using AllElements = testing::Types<
    ElementCase<2, ElementKind::kP1>, ElementCase<2, ElementKind::kMini>, ElementCase<2, ElementKind::kP1P1>,
    ElementCase<2, ElementKind::kP2>, ElementCase<2, ElementKind::kP2P0>, ElementCase<2, ElementKind::kP2P1>,
    ElementCase<3, ElementKind::kP1>, ElementCase<3, ElementKind::kMini>, ElementCase<3, ElementKind::kP1P1>,
    ElementCase<3, ElementKind::kP2>, ElementCase<3, ElementKind::kP2P0>, ElementCase<3, ElementKind::kP2P1>>;

struct ElementCaseName {
  template <typename Case>
  static std::string GetName(int) {
    return elementName(Case::kKind) + (Case::kDim == 2 ? "_in_section" : "_in_space");
  }
};

inline Eigen::VectorXd randomVector(Eigen::Index size, double amplitude, int seed = 7) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> entry(-amplitude, amplitude);
  return Eigen::VectorXd::NullaryExpr(size, [&] { return entry(generator); });
}

/// The unit square (r, z) of the section in n^2 squares of two triangles each.
inline TriangleMesh unitSquare(int n) {
  TriangleMesh mesh;
  const auto vertex = [n](int i, int k) { return i + (n + 1) * k; };
  for (int k = 0; k <= n; ++k) {
    for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(i / double(n), k / double(n));
  }
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1)});
      mesh.triangles.push_back({vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1)});
    }
  }
  return mesh;
}

/// Puts midpoints back to the middle of their edges.
template <int Dim>
QuadraticMesh<Dim> straight(QuadraticMesh<Dim> mesh) {
  for (const auto& nodes : mesh.elements) {
    int next = Dim + 1;
    for (const auto& [a, b] : elementEdges<Dim>()) {
      mesh.nodes[nodes[next++]] = (mesh.nodes[nodes[a]] + mesh.nodes[nodes[b]]) / 2;
    }
  }
  return mesh;
}

/// The unit cube, or the cylinder of radius and height 1, in n pieces along each edge, its inner vertices off the grid.
template <int Dim>
QuadraticMesh<Dim> irregularBlock(int n) {
  const auto linear = [n] {
    if constexpr (Dim == 2) {
      return unitSquare(n);
    } else {
      return unitCube(n);
    }
  };
  auto mesh = linear();
  const int size = static_cast<int>(mesh.vertices.size());
  const Eigen::VectorXd shift = randomVector(Dim * size, 0.15 / n);
  for (int v = 0; v < size; ++v) {
    const bool inner = mesh.vertices[v].minCoeff() > 0 && mesh.vertices[v].maxCoeff() < 1;
    if (inner) mesh.vertices[v] += shift.segment<Dim>(Dim * v);
  }
  return straight(makeQuadratic(mesh, {1.0}));
}

inline std::shared_ptr<const Material> material(const std::string& model, double poisson_ratio, double young = 2) {
  MaterialConfig config;
  config.model = model;
  config.young_modulus = young;
  config.poisson_ratio = poisson_ratio;
  return makeMaterial(config);
}

/// Of one material.
template <int Dim>
std::shared_ptr<LayeredBody<Dim>> makeBody(QuadraticMesh<Dim> mesh, ElementKind kind, const std::string& model,
                                           double poisson_ratio, Inversion inversion = Inversion::kRefused) {
  return std::make_shared<LayeredBody<Dim>>(
      std::move(mesh), kind, typename LayeredBody<Dim>::Materials{material(model, poisson_ratio)}, inversion);
}

inline SymmetricSolver::Method methodFor(ElementKind kind) {
  return hasContinuousPressure(kind) ? SymmetricSolver::Method::kIndefinite : SymmetricSolver::Method::kSimplicial;
}

/// Nodes other than bubbles.
template <int Dim>
int plainNodes(const LayeredBody<Dim>& body) {
  return isQuadratic(body.kind()) ? body.nodeCount() : body.mesh().vertex_count;
}

/// Everything free, but u_r = 0 on the axis of a section.
template <int Dim>
Constraints freeBody(const LayeredBody<Dim>& body) {
  Constraints constraints;
  constraints.entries.assign(body.stateSize(), Constraints::kFree);
  for (int i = Dim * body.nodeCount(); i < body.tipEntry() && body.kind() == ElementKind::kP2P0; ++i) {
    constraints.entries[i] = Constraints::kInternal;
  }
  constraints.pressures = hasContinuousPressure(body.kind()) ? body.pressureCount() : 0;
  for (int k = 0; k < 3; ++k) constraints.entries[body.tipEntry() + k] = Constraints::tip(k);
  for (int n = 0; Dim == 2 && n < plainNodes(body); ++n) {
    if (body.mesh().nodes[n][0] == 0) constraints.entries[Dim * n] = Constraints::kFixed;
  }
  return constraints;
}

/// Holds the nodes whose place is `where`.
template <int Dim, typename Where>
void hold(const LayeredBody<Dim>& body, const Where& where, Constraints& constraints) {
  for (int n = 0; n < plainNodes(body); ++n) {
    for (int k = 0; k < Dim && where(body.mesh().nodes[n]); ++k) constraints.entries[Dim * n + k] = Constraints::kFixed;
  }
}

/// Lets the nodes whose place is `where` follow the tip, which in a section moves along z only.
template <int Dim, typename Where>
void stick(const LayeredBody<Dim>& body, const Where& where, Constraints& constraints) {
  for (int n = 0; n < plainNodes(body); ++n) {
    if (!where(body.mesh().nodes[n])) continue;
    for (int k = 0; k < Dim; ++k) constraints.entries[Dim * n + k] = Constraints::tip(k);
    if (Dim == 2) constraints.entries[Dim * n] = Constraints::kFixed;
    if (Dim == 2) constraints.entries[Dim * n + 1] = Constraints::tip(2);
  }
}

/// A block held at its bottom whose top sticks to the tip.
template <int Dim>
Constraints betweenPlates(const LayeredBody<Dim>& body) {
  using Point = typename QuadraticMesh<Dim>::Point;
  Constraints constraints = freeBody(body);
  hold(
      body, [](const Point& x) { return x[Dim - 1] == 0; }, constraints);
  stick(
      body, [](const Point& x) { return x[Dim - 1] == 1; }, constraints);
  return constraints;
}

/// A ball of radius `radius` about the origin whose lower cap, below -0.7 of it, is held, and whose upper one sticks to
/// the tip.
template <int Dim>
Constraints betweenCaps(const LayeredBody<Dim>& body, double radius) {
  using Point = typename QuadraticMesh<Dim>::Point;
  const auto outside = [=](const Point& x) { return x.norm() > 0.999 * radius; };
  Constraints constraints = freeBody(body);
  hold(
      body, [=](const Point& x) { return outside(x) && x[Dim - 1] < -0.7 * radius; }, constraints);
  stick(
      body, [=](const Point& x) { return outside(x) && x[Dim - 1] > 0.7 * radius; }, constraints);
  return constraints;
}

/// State of a displacement u(X) of all nodes but bubbles; pressures and the tip stay.
template <int Dim, typename Displacement>
Eigen::VectorXd stateOf(const LayeredBody<Dim>& body, const Displacement& displacement) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(body.stateSize());
  for (int n = 0; n < plainNodes(body); ++n) {
    state.template segment<Dim>(Dim * n) = displacement(body.mesh().nodes[n]);
  }
  return state;
}

/// Derivative of a term's whole energy.
inline Eigen::VectorXd gradientOf(const EnergyTerm& term, const Eigen::VectorXd& state) {
  LocalEnergy local;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(state.size());
  for (int e = 0; e < term.elementCount(); ++e) {
    EXPECT_TRUE(term.evaluate(e, state, Order::kGradient, local));
    const std::vector<int>& entries = term.entries(e);
    for (std::size_t i = 0; i < entries.size(); ++i) sum[entries[i]] += local.gradient[i];
  }
  return sum;
}

/// Second derivative of a term's whole energy.
inline Eigen::MatrixXd hessianOf(const EnergyTerm& term, const Eigen::VectorXd& state) {
  LocalEnergy local;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(state.size(), state.size());
  for (int e = 0; e < term.elementCount(); ++e) {
    EXPECT_TRUE(term.evaluate(e, state, Order::kHessian, local));
    const std::vector<int>& entries = term.entries(e);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      for (std::size_t j = 0; j < entries.size(); ++j) sum(entries[i], entries[j]) += local.hessian(i, j);
    }
  }
  return sum;
}

}  // namespace microinjection
