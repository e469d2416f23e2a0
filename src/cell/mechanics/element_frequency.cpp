#include "cell/mechanics/element_frequency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

}  // namespace microinjection
