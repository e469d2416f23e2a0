#include "vision/calibration/statistics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace microinjection {

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

}  // namespace microinjection
