#include "cell/identification/table_law.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

/// Second derivatives of the natural cubic spline (zero at both ends).
Eigen::VectorXd curvatureOf(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
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

}  // namespace

TableLaw::TableLaw(std::string description, const std::vector<double>& depths, const std::vector<double>& forces,
                   double error)
    : description_(std::move(description)), error_(error) {
  const bool ascending = std::is_sorted(depths.begin(), depths.end(), [](double a, double b) { return a <= b; });
  const auto positive = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x) && x > 0; });
  };
  if (depths.size() < 2 || depths.size() != forces.size() || !ascending || !positive(depths) || !positive(forces)) {
    throw std::invalid_argument("TableLaw: needs two or more ascending depths with forces, all > 0");
  }
  const auto count = static_cast<Eigen::Index>(depths.size());
  x_ = Eigen::Map<const Eigen::VectorXd>(depths.data(), count).array().log();
  y_ = Eigen::Map<const Eigen::VectorXd>(forces.data(), count).array().log();
  curvature_ = curvatureOf(x_, y_);
}

double TableLaw::deepest() const { return std::exp(x_[x_.size() - 1]); }

ElasticLaw::Value TableLaw::force(double depth, Eigen::VectorXd& by_logarithms) const {
  by_logarithms.resize(0);
  if (!(depth > 0)) return {};
  const Eigen::Index last = x_.size() - 1;
  const double at = std::log(depth), inside = std::clamp(at, x_[0], x_[last]);
  const Eigen::Index above =
      std::clamp<Eigen::Index>(std::upper_bound(x_.data(), x_.data() + x_.size(), inside) - x_.data(), 1, last);
  const double width = x_[above] - x_[above - 1];
  const double b = (inside - x_[above - 1]) / width, a = 1 - b;
  const double square = width * width / 6;
  double y = a * y_[above - 1] + b * y_[above] +
             square * ((a * a * a - a) * curvature_[above - 1] + (b * b * b - b) * curvature_[above]);
  const double slope = (y_[above] - y_[above - 1]) / width +
                       width / 6 * ((3 * b * b - 1) * curvature_[above] - (3 * a * a - 1) * curvature_[above - 1]);
  y += slope * (at - inside);
  const double force = std::exp(y);
  return {force, slope * force / depth};
}

}  // namespace microinjection
