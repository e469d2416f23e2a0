#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cell/identification/elastic_law.h"
#include "cell/identification/force_curve.h"

namespace microinjection {

/// Which parameters a fit may change beside modulus, contact point and the sensor's offset.
struct CurveModelConfig {
  bool drift = true;    ///< of the sensor, linear in time
  int prony_terms = 0;  ///< of the cell's relaxation
};

/// The measured force of a record as a function of unknown parameters:
///
///     F(t) = offset + drift (t - t_0) + E f(z(t) - z_0; ratios) + relaxation,
///
/// with z_0 the contact point, f the elastic law, and a Prony series (see ForceMemory) driven by the
/// elastic force.
class CurveModel {
 public:
  /// An unknown. What is positive is represented by its logarithm.
  struct Unknown {
    std::string name, unit;
    bool logarithm = false;
    double value = 0;                   ///< internal: the logarithm or the value over `scale`
    double scale = 1;                   ///< SI value of one internal unit; 1 for a logarithm
    double low = -1e300, high = 1e300;  ///< internal

    double si(double internal) const;
  };

  CurveModel(const ForceCurve& curve, std::shared_ptr<ElasticLaw> law, const CurveModelConfig& config);

  /// To begin with: see guessContact. In SI units.
  void start(double modulus, double contact, double offset, double drift);

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  std::vector<Unknown>& unknowns() { return unknowns_; }
  int index(const std::string& name) const;  ///< -1 when there is none
  const ElasticLaw& law() const { return *law_; }
  const ForceCurve& curve() const { return curve_; }

  /// Force (N) of each sample, and its derivatives by the unknowns (a row a sample).
  void predict(const Eigen::VectorXd& internal, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian);

 private:
  void addElastic(const Eigen::VectorXd& internal, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian);
  void addRelaxation(const Eigen::VectorXd& internal, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian) const;

  const ForceCurve& curve_;
  std::shared_ptr<ElasticLaw> law_;
  int terms_ = 0;
  std::vector<Unknown> unknowns_;
  int ratios_ = 0, prony_ = 0;  ///< index of the first one
};

}  // namespace microinjection
