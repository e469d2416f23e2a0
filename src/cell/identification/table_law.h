#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cell/identification/elastic_law.h"

namespace microinjection {

/// A force that is known at some depths, as of a solution. Between them, the logarithm of the force is a
/// natural cubic spline of that of the depth: exact for every power. Above the first one and below the
/// last one it goes on as a power.
class TableLaw : public ElasticLaw {
 public:
  /// `depths`: m, > 0, ascending, two or more; `forces`: N/Pa, > 0; `error`: relative, median. Throws
  /// std::invalid_argument otherwise.
  TableLaw(std::string description, const std::vector<double>& depths, const std::vector<double>& forces, double error);

  std::string description() const override { return description_; }
  Value force(double depth, Eigen::VectorXd& by_logarithms) const override;
  double deepest() const override;
  double error() const override { return error_; }

 private:
  std::string description_;
  double error_;
  Eigen::VectorXd x_, y_, curvature_;  ///< logarithms of depth and force, second derivatives
};

}  // namespace microinjection
