#include "cell/identification/point_identification.h"

#include <cmath>
#include <cstdio>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kBoundOverMedian = 2.906;  ///< 1.96 x 1.4826: 95 % over the median size of a normal error

}  // namespace

Identification identifyPoint(const MeasuredPoint& point, const ElasticLaw& law) {
  if (point.depth > law.deepest() * (1 + 1e-9)) {
    char text[120];
    std::snprintf(text, sizeof(text), "the point is %.3g um deep: the model reaches %.3g um", 1e6 * point.depth,
                  1e6 * law.deepest());
    throw ConfigError(text);
  }
  Eigen::VectorXd none;
  const ElasticLaw::Value value = law.force(point.depth, none);
  const double modulus = point.force / value.force;
  const double by_depth = value.stiffness * point.depth_error / value.force;
  const double error = std::hypot(point.reading_error, std::hypot(by_depth, kBoundOverMedian * law.error()));
  Identification result;
  result.model = law.description();
  result.estimates = {{"young_modulus", "Pa", modulus, modulus * (1 - error), modulus * (1 + error), true}};
  result.depth = point.depth;
  result.size = point.force;
  result.warnings.emplace_back("one point: the contact is taken as known, and whether the model fits is not tested");
  return result;
}

}  // namespace microinjection
