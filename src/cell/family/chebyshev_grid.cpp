#include "cell/family/chebyshev_grid.h"

#include <cmath>

namespace microinjection {

ChebyshevGrid::ChebyshevGrid(int dimension, int points) : dimension_(dimension), points_(points) {
  for (int i = 0; i < points; ++i) points_[i] = -std::cos(M_PI * i / (points - 1));
}

int ChebyshevGrid::size() const {
  return static_cast<int>(std::lround(std::pow(static_cast<double>(points_.size()), dimension_)));
}

Eigen::VectorXd ChebyshevGrid::node(int index) const {
  const auto count = static_cast<int>(points_.size());
  Eigen::VectorXd result(dimension_);
  for (double& x : result) {
    x = points_[index % count];
    index /= count;
  }
  return result;
}

Eigen::VectorXd ChebyshevGrid::weights(double at) const {
  const Eigen::Index last = points_.size() - 1;
  Eigen::VectorXd result(points_.size());
  for (Eigen::Index i = 0; i <= last; ++i) {
    const double distance = at - points_[i];
    if (distance == 0) return Eigen::VectorXd::Unit(points_.size(), i);
    result[i] = (i % 2 == 0 ? 1 : -1) * (i == 0 || i == last ? 0.5 : 1) / distance;
  }
  return result / result.sum();
}

double ChebyshevGrid::interpolate(const Eigen::VectorXd& values, const Eigen::VectorXd& at) const {
  // One coordinate after the other, the first of them varies fastest.
  Eigen::VectorXd rest = values;
  for (const double x : at) {
    const Eigen::VectorXd own = weights(x);
    const Eigen::Map<const Eigen::MatrixXd> table(rest.data(), own.size(), rest.size() / own.size());
    rest = (table.transpose() * own).eval();
  }
  return rest[0];
}

}  // namespace microinjection
