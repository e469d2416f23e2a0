#include "cell/mechanics/largest_frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cell/mechanics/p1_body.h"

namespace microinjection {

double elementFrequency(const TetMesh& mesh, std::size_t tetrahedron, const Lame& lame, double density) {
  const Eigen::Matrix<double, 3, 4> g = shapeGradients(mesh, tetrahedron);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(g * g.transpose(), Eigen::EigenvaluesOnly);
  const Eigen::Vector3d c = solver.eigenvalues().cwiseMax(0), root = c.cwiseSqrt();  // ascending
  const Eigen::Matrix3d volumetric =
      Eigen::Matrix3d((2 * lame.mu * c).asDiagonal()) + lame.lambda * root * root.transpose();
  solver.computeDirect(volumetric, Eigen::EigenvaluesOnly);
  const double stiffest = std::max(solver.eigenvalues()[2], lame.mu * (c[1] + c[2]));
  return std::sqrt(4 * stiffest / density);
}

double frequencyBound(const TetMesh& mesh, const Lame& lame, double density) {
  double highest = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    highest = std::max(highest, elementFrequency(mesh, t, lame, density));
  }
  return highest;
}

double largestEigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map, Eigen::VectorXd start,
                         const PowerIteration& config) {
  Eigen::VectorXd mode = std::move(start);
  double length = mode.norm(), eigenvalue = 0;
  for (int i = 0; i < config.iterations && length > 0; ++i) {
    mode = map(mode / length);
    length = mode.norm();
    const double last = std::exchange(eigenvalue, length);
    if (std::abs(eigenvalue - last) < config.tolerance * eigenvalue) break;
  }
  return eigenvalue;
}

double largestFrequency(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses) {
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  Eigen::VectorXd start(masses.size());
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = std::sin(1.0 + static_cast<double>(i));
  const auto map = [&](const Eigen::VectorXd& mode) -> Eigen::VectorXd {
    const Eigen::VectorXd force = lower.selfadjointView<Eigen::Lower>() * scale.cwiseProduct(mode);
    return scale.cwiseProduct(force);
  };
  return std::sqrt(largestEigenvalue(map, start));
}

}  // namespace microinjection
