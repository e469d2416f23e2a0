#include "cell/identification/table_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cell/identification/natural_spline.h"

namespace microinjection {

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
  curvature_ = naturalSplineCurvature(x_, y_);
}

double TableLaw::deepest() const { return std::exp(x_[x_.size() - 1]); }

ElasticLaw::Value TableLaw::force(double depth, Eigen::VectorXd& by_logarithms) const {
  by_logarithms.resize(0);
  if (!(depth > 0)) return {};
  const auto [y, slope] = naturalSpline(x_, y_, curvature_, std::log(depth));
  const double force = std::exp(y);
  return {force, slope * force / depth};
}

}  // namespace microinjection
