#include "cell/identification/interpolated_law.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "cell/identification/natural_spline.h"

namespace microinjection {

InterpolatedLaw::InterpolatedLaw(std::string parameter, double value, const std::map<double, TableLaw>& laws)
    : parameter_(std::move(parameter)), x_(static_cast<Eigen::Index>(laws.size())) {
  if (laws.size() < 2 || !(laws.begin()->first > 0)) {
    throw std::invalid_argument("InterpolatedLaw: needs laws of two or more values > 0");
  }
  for (const auto& [at, law] : laws) {
    x_[static_cast<Eigen::Index>(laws_.size())] = std::log(at);
    laws_.push_back(law);
  }
  set(Eigen::VectorXd::Constant(1, std::clamp(value, laws.begin()->first, laws.rbegin()->first)));
}

std::string InterpolatedLaw::description() const {
  char text[120];
  std::snprintf(text, sizeof(text), ", of %d values of %s from %.3g to %.3g", static_cast<int>(laws_.size()),
                parameter_.c_str(), std::exp(x_[0]), std::exp(x_[x_.size() - 1]));
  return laws_.front().description() + text;
}

std::vector<ElasticLaw::Parameter> InterpolatedLaw::parameters() const {
  return {{parameter_, value_, std::exp(x_[0]), std::exp(x_[x_.size() - 1])}};
}

/// The spline is linear in what it interpolates: what a law contributes is the spline that is 1 at its value and 0 at
/// the others, for all depths.
void InterpolatedLaw::set(const Eigen::VectorXd& values) {
  value_ = values[0];
  const double x = std::log(value_);
  const Eigen::Index count = x_.size();
  weights_.resize(count);
  by_x_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd own = Eigen::VectorXd::Unit(count, k);
    const auto [weight, slope] = naturalSpline(x_, own, naturalSplineCurvature(x_, own), x);
    weights_[k] = weight;
    by_x_[k] = slope;
  }
  const Eigen::Index above =
      std::clamp<Eigen::Index>(std::upper_bound(x_.data(), x_.data() + count, x) - x_.data(), 1, count - 1);
  const auto deepest = [&](Eigen::Index k) { return laws_[static_cast<std::size_t>(k)].deepest(); };
  deepest_ = std::min(deepest(above - 1), deepest(above));
}

ElasticLaw::Value InterpolatedLaw::force(double depth, Eigen::VectorXd& by_logarithms) const {
  by_logarithms.setZero(1);
  if (!(depth > 0)) return {};
  double logarithm = 0, by_x = 0, by_depth = 0;  // of the force's logarithm
  Eigen::VectorXd none;
  for (std::size_t k = 0; k < laws_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Value known = laws_[k].force(depth, none);
    logarithm += weights_[i] * std::log(known.force);
    by_x += by_x_[i] * std::log(known.force);
    by_depth += weights_[i] * known.stiffness / known.force;
  }
  const double force = std::exp(logarithm);
  by_logarithms[0] = force * by_x;
  return {force, force * by_depth};
}

double InterpolatedLaw::error() const {
  double largest = 0;
  for (const TableLaw& law : laws_) largest = std::max(largest, law.error());
  return largest;
}

}  // namespace microinjection
