#include "cell/mechanics/largest_frequency.h"

#include <cmath>
#include <utility>

namespace microinjection {

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
