#include "cell/surrogate/radial_basis.h"

#include <Eigen/LU>

namespace microinjection {
namespace {

double cube(double x) { return x * x * x; }

}  // namespace

Eigen::VectorXd radialBasis(const Eigen::MatrixXd& centres, const Eigen::VectorXd& at) {
  const Eigen::Index count = centres.cols();
  Eigen::VectorXd values(count + 1 + centres.rows());
  for (Eigen::Index i = 0; i < count; ++i) values[i] = cube((centres.col(i) - at).norm());
  values[count] = 1;
  values.tail(centres.rows()) = at;
  return values;
}

Eigen::MatrixXd radialWeights(const Eigen::MatrixXd& centres, const Eigen::MatrixXd& values) {
  const Eigen::Index count = centres.cols(), size = count + 1 + centres.rows();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size), right = Eigen::MatrixXd::Zero(size, values.cols());
  for (Eigen::Index i = 0; i < count; ++i) system.row(i) = radialBasis(centres, centres.col(i)).transpose();
  system.bottomLeftCorner(size - count, count) = system.topRightCorner(count, size - count).transpose();
  right.topRows(count) = values;
  return system.partialPivLu().solve(right);
}

}  // namespace microinjection
