#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "cell/identification/elastic_law.h"
#include "cell/identification/table_law.h"

namespace microinjection {

/// The force that is known at some values of one parameter, as of solutions of a scene with several exponents of its
/// material. Between them, the logarithm of the force at a depth is a natural cubic spline of that of the parameter:
/// the force stays positive, and a fit has a derivative everywhere.
class InterpolatedLaw : public ElasticLaw {
 public:
  /// `parameter`: its name; `value`: to begin with; `laws`: of each value (> 0) of it, two or more. The parameter's
  /// bounds are the first and the last of them. Throws std::invalid_argument otherwise.
  InterpolatedLaw(std::string parameter, double value, const std::map<double, TableLaw>& laws);

  std::string description() const override;
  std::vector<Parameter> parameters() const override;
  void set(const Eigen::VectorXd& values) override;
  Value force(double depth, Eigen::VectorXd& by_logarithms) const override;
  /// Of the two laws that the parameter lies between, the less deep one's.
  double deepest() const override { return deepest_; }
  /// The largest of the laws.
  double error() const override;

 private:
  std::string parameter_;
  double value_ = 1;
  std::vector<TableLaw> laws_;
  Eigen::VectorXd x_;               ///< logarithms of the parameter's values, ascending
  Eigen::VectorXd weights_, by_x_;  ///< of the laws' logarithms at `value_`, and their derivatives
  double deepest_ = 0;              ///< m
};

}  // namespace microinjection
