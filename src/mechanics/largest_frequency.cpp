#include "mechanics/largest_frequency.h"

#include <cmath>

namespace microinjection {

double largestFrequency(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses) {
  constexpr int kIterations = 3000;
  constexpr double kTolerance = 1e-9;  // of the eigenvalue, from one iteration to the next
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  Eigen::VectorXd mode(masses.size());
  for (Eigen::Index i = 0; i < mode.size(); ++i) mode[i] = std::sin(1.0 + static_cast<double>(i));
  mode.normalize();
  double eigenvalue = 0;
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd force = lower.selfadjointView<Eigen::Lower>() * scale.cwiseProduct(mode);
    Eigen::VectorXd next = scale.cwiseProduct(force);
    const double last = eigenvalue;
    eigenvalue = next.norm();
    if (eigenvalue == 0) return 0;
    mode = next / eigenvalue;
    if (std::abs(eigenvalue - last) < kTolerance * eigenvalue) break;
  }
  return std::sqrt(eigenvalue);
}

}  // namespace microinjection
