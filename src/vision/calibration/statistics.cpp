#include "vision/calibration/statistics.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kSmallest = 1e-3;  ///< of the median distance, below which a weight no longer grows

}  // namespace

double studentLimit(double confidence, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.5 + 0.5 * confidence);
}

double fisherLimit(double confidence, double n, double m) {
  return boost::math::quantile(boost::math::fisher_f(n, m), confidence);
}

double robustDeviation(const std::vector<double>& values) {
  const double median = medianOf(values);
  std::vector<double> distances;
  distances.reserve(values.size());
  for (const double value : values) distances.push_back(std::abs(value - median));
  return 1.4826 * medianOf(distances);
}

bool isCovariance(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite() || !matrix.isApprox(matrix.transpose(), 1e-6)) return false;
  return (matrix.diagonal().array() > 0).all() && Eigen::LLT<Eigen::MatrixXd>(matrix).info() == Eigen::Success;
}

Eigen::MatrixXd leastDistances(const Eigen::MatrixXd& regressors, const Eigen::MatrixXd& observed, int iterations) {
  if (observed.rows() < regressors.cols()) return {};
  Eigen::VectorXd root = Eigen::VectorXd::Ones(observed.rows());
  Eigen::MatrixXd solution;
  for (int i = 0; i < iterations; ++i) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(root.asDiagonal() * regressors);
    if (qr.rank() < regressors.cols()) return {};
    solution = qr.solve(root.asDiagonal() * observed);
    const Eigen::VectorXd distance = (observed - regressors * solution).rowwise().norm();
    const double median = medianOf({distance.data(), distance.data() + distance.size()});
    if (median <= 0) break;
    root = (distance.array() / median).max(kSmallest).rsqrt();
  }
  return solution;
}

}  // namespace microinjection
