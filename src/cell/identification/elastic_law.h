#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// The elastic force of a cell on a tip, as a function of the depth, for a modulus of 1 Pa: all laws
/// here are proportional to the modulus. Some have further parameters, which are ratios.
class ElasticLaw {
 public:
  struct Parameter {
    std::string name;
    double value = 1, low = 0, high = 0;  ///< a ratio > 0; `value` to begin with
  };

  virtual ~ElasticLaw() = default;

  /// One line for the user.
  virtual std::string description() const = 0;
  /// Parameters beside the modulus, which a fit may change.
  virtual std::vector<Parameter> parameters() const { return {}; }
  /// Sets them all. The logarithms are used by force().
  virtual void set(const Eigen::VectorXd& values) { (void)values; }

  struct Value {
    double force = 0;      ///< N/Pa
    double stiffness = 0;  ///< N/m/Pa, derivative by the depth
  };
  /// `depth`: m, >= 0. `by_logarithms` (N/Pa): derivatives by the logarithms of the parameters.
  virtual Value force(double depth, Eigen::VectorXd& by_logarithms) const = 0;

  /// m, of the law's range.
  virtual double deepest() const = 0;
  /// Expected relative error of the force.
  virtual double error() const { return 0; }
};

}  // namespace microinjection
