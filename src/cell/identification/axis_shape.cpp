#include "cell/identification/axis_shape.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr int kTableSteps = 96;

}  // namespace

AxisShape::AxisShape(const std::function<double(double)>& force, double deepest) : deepest_(deepest) {
  values_.resize(kTableSteps + 1);
  for (int i = 1; i <= kTableSteps; ++i) {
    const double root = static_cast<double>(i) / kTableSteps;
    values_[static_cast<std::size_t>(i)] = force(root * root * deepest) / std::pow(root, 3);
  }
  values_[0] = values_[1];  // a force over no depth is lost in rounding
}

ElasticLaw::Value AxisShape::at(double depth) const {
  if (!(depth > 0)) return {};
  const double inside = std::min(depth, deepest_), root = std::sqrt(inside / deepest_);
  const auto i = std::min(static_cast<std::size_t>(root * kTableSteps), static_cast<std::size_t>(kTableSteps - 1));
  const double slope = (values_[i + 1] - values_[i]) * kTableSteps;
  const double value = values_[i] + slope * (root - static_cast<double>(i) / kTableSteps);
  const double force = root * root * root * value;
  const double stiffness = (3 * root * value + root * root * slope) / (2 * deepest_);
  return {force + stiffness * (depth - inside), stiffness};
}

}  // namespace microinjection
