#include "cell/family/kriging.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kLeastNoise = 1e-10;  ///< smallest noise

}  // namespace

Kriging::Kriging(const Eigen::MatrixXd& points, const Eigen::VectorXd& lengths, double noise)
    : points_(points), lengths_(lengths) {
  const Eigen::Index count = points.cols(), dimension = points.rows();
  if (count >= 2 * dimension + 2) drift_ = 1 + dimension;  // with fewer points, a linear one is not determined
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(count + drift_, count + drift_);
  for (Eigen::Index i = 0; i < count; ++i) system.row(i) = basis(points.col(i)).transpose();
  system.bottomLeftCorner(drift_, count) = system.topRightCorner(count, drift_).transpose();
  system.diagonal().head(count).array() += std::max(noise, kLeastNoise);
  inverse_ = system.fullPivLu().inverse();
}

Eigen::VectorXd Kriging::basis(const Eigen::VectorXd& at) const {
  const Eigen::Index count = points_.cols();
  Eigen::VectorXd values(count + drift_);
  for (Eigen::Index i = 0; i < count; ++i) {
    values[i] = std::exp(-0.5 * (points_.col(i) - at).cwiseQuotient(lengths_).squaredNorm());
  }
  values[count] = 1;
  values.tail(drift_ - 1) = at.head(drift_ - 1);
  return values;
}

Eigen::VectorXd Kriging::weights(const Eigen::VectorXd& at) const {
  return (inverse_ * basis(at)).head(points_.cols());
}

double Kriging::deviation(const Eigen::VectorXd& at) const {
  const Eigen::VectorXd known = basis(at);
  return std::sqrt(std::max(0.0, 1 - known.dot(inverse_ * known)));
}

Eigen::MatrixXd Kriging::leaveOneOut() const {
  const Eigen::Index count = points_.cols();
  Eigen::MatrixXd result = inverse_.topLeftCorner(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    result.row(i) /= -result(i, i);
    result(i, i) = 0;
  }
  return result;
}

}  // namespace microinjection
