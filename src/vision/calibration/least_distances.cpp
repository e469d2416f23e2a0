#include "vision/calibration/least_distances.h"

#include <Eigen/QR>

#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr double kSmallest = 1e-3;  ///< of the median distance, below which a weight no longer grows

}  // namespace

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
