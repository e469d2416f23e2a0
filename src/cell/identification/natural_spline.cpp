#include "cell/identification/natural_spline.h"

#include <Eigen/LU>
#include <algorithm>

namespace microinjection {

Eigen::VectorXd naturalSplineCurvature(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Index n = x.size();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double before = x[i] - x[i - 1], behind = x[i + 1] - x[i];
    matrix(i, i - 1) = before / 6;
    matrix(i, i) = (before + behind) / 3;
    matrix(i, i + 1) = behind / 6;
    right[i] = (y[i + 1] - y[i]) / behind - (y[i] - y[i - 1]) / before;
  }
  return matrix.partialPivLu().solve(right);
}

SplineValue naturalSpline(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& curvature,
                          double at) {
  const Eigen::Index last = x.size() - 1;
  const double inside = std::clamp(at, x[0], x[last]);
  const Eigen::Index above =
      std::clamp<Eigen::Index>(std::upper_bound(x.data(), x.data() + x.size(), inside) - x.data(), 1, last);
  const double width = x[above] - x[above - 1];
  const double b = (inside - x[above - 1]) / width, a = 1 - b;
  const double square = width * width / 6;
  const double value = a * y[above - 1] + b * y[above] +
                       square * ((a * a * a - a) * curvature[above - 1] + (b * b * b - b) * curvature[above]);
  const double slope = (y[above] - y[above - 1]) / width +
                       width / 6 * ((3 * b * b - 1) * curvature[above] - (3 * a * a - 1) * curvature[above - 1]);
  return {value + slope * (at - inside), slope};
}

}  // namespace microinjection
