// Observed order of convergence of each element on a smooth problem with an exact solution.

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mesh/cell_mesher.h"
#include "cell/mesh/section_mesher.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6;  ///< m
constexpr double kPi = 3.14159265358979323846;
constexpr double kStrain = 1e-3;  ///< scale of the gradient; the problem is linear

/// Exact solution of linear elasticity without body force (Papkovich, Neuber): with harmonic c and
/// d,
///
///     u = c e_z - grad(z c) / (4 (1 - nu)) + grad(d),    p = lambda div u = mu nu / (1 - nu) dc/dz;
///
/// the pressure is smooth, not zero, and bounded as nu goes to 1/2. c = z^4 - 3 z^2 r^2 + 3/8 r^4;
/// d, in space only, = (x^4 - 6 x^2 y^2 + y^4) / 5. Lengths in radii of the ball.
class ExactSolution {
 public:
  ExactSolution(double poisson_ratio, int dimension)
      : share_(0.25 / (1 - poisson_ratio)), around_(dimension == 3 ? 0.2 : 0) {}

  /// m
  Eigen::Vector3d displacement(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d x = place / kRadius;
    Eigen::Vector3d u = -share_ * x.z() * gradC(x);
    u.z() += (1 - share_) * c(x);
    const double xx = x.x() * x.x(), yy = x.y() * x.y();
    u += around_ * Eigen::Vector3d(4 * x.x() * (xx - 3 * yy), 4 * x.y() * (yy - 3 * xx), 0);
    return kStrain * kRadius * u;
  }

  Eigen::Matrix3d gradient(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d x = place / kRadius, up = Eigen::Vector3d::UnitZ(), slope = gradC(x);
    Eigen::Matrix3d g = (1 - share_) * up * slope.transpose();
    g -= share_ * (x.z() * hessianC(x) + slope * up.transpose());
    const double twist = 12 * (x.x() * x.x() - x.y() * x.y()), cross = -24 * x.x() * x.y();
    Eigen::Matrix3d d;
    d << twist, cross, 0, cross, -twist, 0, 0, 0, 0;
    return kStrain * (g + around_ * d);
  }

 private:
  static double c(const Eigen::Vector3d& x) {
    const double s = x.head<2>().squaredNorm(), zz = x.z() * x.z();
    return zz * zz - 3 * zz * s + 0.375 * s * s;
  }
  static Eigen::Vector3d gradC(const Eigen::Vector3d& x) {
    const double s = x.head<2>().squaredNorm(), zz = x.z() * x.z(), lateral = 1.5 * s - 6 * zz;
    return {lateral * x.x(), lateral * x.y(), x.z() * (4 * zz - 6 * s)};
  }
  static Eigen::Matrix3d hessianC(const Eigen::Vector3d& x) {
    const double s = x.head<2>().squaredNorm(), zz = x.z() * x.z();
    Eigen::Matrix3d h;
    h.topLeftCorner<2, 2>() =
        (1.5 * s - 6 * zz) * Eigen::Matrix2d::Identity() + 3 * x.head<2>() * x.head<2>().transpose();
    h.topRightCorner<2, 1>() = -12 * x.z() * x.head<2>();
    h.bottomLeftCorner<1, 2>() = h.topRightCorner<2, 1>().transpose();
    h(2, 2) = 12 * zz - 6 * s;
    return h;
  }

  double share_;   ///< 1 / (4 (1 - nu))
  double around_;  ///< of grad(d)
};

/// A place (x, y, z) of a section's (r, z), or of space.
Eigen::Vector3d inSpace(const Eigen::Vector2d& rz) { return {rz[0], 0, rz[1]}; }
Eigen::Vector3d inSpace(const Eigen::Vector3d& x) { return x; }

template <int Dim>
QuadraticMesh<Dim> makeMesh(double size);

template <>
QuadraticMesh<2> makeMesh<2>(double size) {
  SectionMeshConfig config;
  config.size = size;
  return makeQuadratic(makeSectionMesh(config), config.radii);
}

template <>
QuadraticMesh<3> makeMesh<3>(double size) {
  CellMeshConfig config;
  config.size = size;
  return makeQuadratic(makeCellMesh(config), config.radii);
}

/// Root of the elements' mean area or volume, m.
template <int Dim>
double meanSize(const QuadraticMesh<Dim>& mesh) {
  const double count = static_cast<double>(mesh.elements.size());
  return Dim == 2 ? kRadius * std::sqrt(kPi / 2 / count) : kRadius * std::cbrt(4 * kPi / 3 / count);
}

template <int Dim>
Constraints constraints(const LayeredBody<Dim>& body) {
  const QuadraticMesh<Dim>& mesh = body.mesh();
  const int nodes = isQuadratic(body.kind()) ? static_cast<int>(mesh.nodes.size()) : mesh.vertex_count;
  Constraints result;
  result.entries.assign(body.stateSize(), Constraints::kFree);
  std::fill_n(result.entries.begin() + body.tipEntry(), 3, Constraints::kFixed);
  if (hasContinuousPressure(body.kind())) {
    result.pressures = body.pressureCount();
  } else {
    std::fill_n(result.entries.end() - 3 - body.pressureCount(), body.pressureCount(), Constraints::kInternal);
  }
  for (int node = 0; Dim == 2 && node < nodes; ++node) {
    if (mesh.nodes[node][0] == 0) result.entries[Dim * node] = Constraints::kFixed;
  }
  for (const auto& facet : mesh.facets) {
    for (int node : facet.nodes) {
      for (int k = 0; node < nodes && k < Dim; ++k) result.entries[Dim * node + k] = Constraints::kFixed;
    }
  }
  return result;
}

/// The exact displacement of the surface's nodes, zero elsewhere.
template <int Dim>
Eigen::VectorXd prescribed(const LayeredBody<Dim>& body, const ExactSolution& exact) {
  Eigen::VectorXd state = Eigen::VectorXd::Zero(body.stateSize());
  for (const auto& facet : body.mesh().facets) {
    for (int node : facet.nodes) {
      if (node >= body.nodeCount() || (!isQuadratic(body.kind()) && node >= body.mesh().vertex_count)) continue;
      const Eigen::Vector3d u = exact.displacement(inSpace(body.mesh().nodes[node]));
      for (int k = 0; k < Dim; ++k) state[Dim * node + k] = Dim == 2 && k == 1 ? u.z() : u[k];
    }
  }
  return state;
}

/// Shape functions at a place of the reference element, and their derivatives by its coordinates
/// (nodes x Dim).
struct Shape {
  Eigen::VectorXd value;
  Eigen::MatrixXd gradient;
};

/// `dl`: derivatives of the barycentric coordinates l
template <int Dim>
Shape quadraticShape(const Eigen::VectorXd& l, const Eigen::MatrixXd& dl) {
  const auto& edges = elementEdges<Dim>();
  const int nodes = Dim + 1 + static_cast<int>(edges.size());
  Shape shape{Eigen::VectorXd(nodes), Eigen::MatrixXd(nodes, Dim)};
  for (int i = 0; i <= Dim; ++i) {
    shape.value[i] = l[i] * (2 * l[i] - 1);
    shape.gradient.row(i) = (4 * l[i] - 1) * dl.row(i);
  }
  int next = Dim + 1;
  for (const auto& [a, b] : edges) {
    shape.value[next] = 4 * l[a] * l[b];
    shape.gradient.row(next++) = 4 * (l[a] * dl.row(b) + l[b] * dl.row(a));
  }
  return shape;
}

/// Displacement gradient from that in the section, and the hoop's strain.
Eigen::Matrix3d wholeGradient(const Eigen::Matrix2d& rz, double hoop) {
  Eigen::Matrix3d g;
  g << rz(0, 0), 0, rz(0, 1), 0, hoop, 0, rz(1, 0), 0, rz(1, 1);
  return g;
}
Eigen::Matrix3d wholeGradient(const Eigen::Matrix3d& gradient, double /*hoop*/) { return gradient; }

/// Norm of the gradient's error over that of the exact gradient, in L2 over the body. Integrated
/// with the rule of `mini`, in space the finest: with that of their own, quadratic elements would
/// not see all of their error.
template <int Dim>
double gradientError(const LayeredBody<Dim>& body, const ExactSolution& exact, const Eigen::VectorXd& state) {
  using Vector = Eigen::Matrix<double, Dim, 1>;
  using Matrix = Eigen::Matrix<double, Dim, Dim>;
  double error = 0, norm = 0;
  for (const ReferenceElement::Point& at : referenceElement<Dim>(ElementKind::kMini).points) {
    const Shape linear{at.map, at.map_gradient}, quadratic = quadraticShape<Dim>(at.map, at.map_gradient);
    const Shape& map = isQuadratic(body.kind()) ? quadratic : linear;
    const Shape shape = body.kind() == ElementKind::kMini ? Shape{at.shape, at.gradient} : map;
    const int count = static_cast<int>(shape.value.size());
    for (int e = 0; e < body.elementCount(); ++e) {
      Vector x = Vector::Zero(), u = Vector::Zero();
      Matrix jacobian = Matrix::Zero(), slope = Matrix::Zero();
      for (int a = 0; a < map.value.size(); ++a) {
        const Vector& node = body.mesh().nodes[body.mesh().elements[e][a]];
        x += map.value[a] * node;
        jacobian += node * map.gradient.row(a);
      }
      for (int a = 0; a < count; ++a) {
        Vector nodal;
        for (int k = 0; k < Dim; ++k) nodal[k] = state[body.entries(e)[k * count + a]];
        u += shape.value[a] * nodal;
        slope += nodal * shape.gradient.row(a);
      }
      const Matrix gradient = slope * jacobian.inverse();
      const double weight = at.weight * jacobian.determinant() * (Dim == 2 ? 2 * kPi * x[0] : 1);
      const Eigen::Matrix3d wanted = exact.gradient(inSpace(x));
      error += weight * (wholeGradient(gradient, u[0] / x[0]) - wanted).squaredNorm();
      norm += weight * wanted.squaredNorm();
    }
  }
  return std::sqrt(error / norm);
}

SymmetricSolver::Method method(ElementKind kind) {
  return hasContinuousPressure(kind) ? SymmetricSolver::Method::kIndefinite : SymmetricSolver::Method::kSupernodal;
}

struct Measurement {
  double size = 0;  ///< m
  int unknowns = 0;
  double error = 0;  ///< see gradientError
};

/// nan when the equations cannot be solved.
template <int Dim>
Measurement measure(const QuadraticMesh<Dim>& mesh, ElementKind kind, double poisson_ratio) {
  MaterialConfig material;
  material.model = "linear";
  material.poisson_ratio = poisson_ratio;
  const ExactSolution exact(poisson_ratio, Dim);
  typename LayeredBody<Dim>::Materials materials = {makeMaterial(material)};
  const auto body = std::make_shared<LayeredBody<Dim>>(mesh, kind, materials);
  EquilibriumSystem system({body}, constraints(*body), method(kind));
  Measurement result{meanSize(mesh), system.freeSize(), std::numeric_limits<double>::quiet_NaN()};
  Eigen::VectorXd state = prescribed(*body, exact), residual;
  Eigen::Vector3d reaction;
  if (!system.factorise(state) || !system.residual(state, residual, reaction)) return result;
  system.addTo(state, -system.solve(residual), Eigen::Vector3d::Zero());
  result.error = gradientError(*body, exact, state);
  return result;
}

template <int Dim>
std::string rows(const std::vector<double>& sizes) {
  std::vector<QuadraticMesh<Dim>> meshes;
  meshes.reserve(sizes.size());
  for (const double size : sizes) meshes.push_back(makeMesh<Dim>(size));
  std::string rows;
  for (const std::string& element : elementNames()) {
    for (const double poisson_ratio : {0.3, 0.499}) {
      Measurement before;
      for (const QuadraticMesh<Dim>& mesh : meshes) {
        // In space the factor of p2_p1 on the finest mesh takes more than a minute.
        if (Dim == 3 && element == "p2_p1" && &mesh == &meshes.back()) continue;
        const Measurement now = measure(mesh, elementKind(element), poisson_ratio);
        const double order = before.size == 0 ? std::numeric_limits<double>::quiet_NaN()
                                              : std::log(now.error / before.error) / std::log(now.size / before.size);
        char row[200];
        std::snprintf(row, sizeof(row), "%d,%s,%.3g,%.4g,%d,%.5g,%.3f\n", Dim, element.c_str(), poisson_ratio, now.size,
                      now.unknowns, now.error, order);
        std::cout << row << std::flush;
        rows += row;
        before = now;
      }
    }
  }
  return rows;
}

std::string table() {
  const std::string header = "dimension,element,poisson_ratio,size_m,unknowns,gradient_error,order\n";
  std::cout << header;
  const std::string section = rows<2>({8e-6, 4e-6, 2e-6, 1e-6});
  return header + section + rows<3>({16e-6, 8e-6, 4e-6, 3.2e-6});
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(
      argc, argv, "convergence_order: error of the displacement gradient and its order in the elements' size",
      microinjection::table);
}
