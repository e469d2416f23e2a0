#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "cell/identification/curve_model.h"

namespace microinjection {

/// The least-squares fit of a model to a record.
struct CurveFit {
  Eigen::VectorXd internal;    ///< of the unknowns
  Eigen::MatrixXd covariance;  ///< of `internal`, from the Hessian; zero rows for what is held
  double cost = 0;             ///< half of the sum of squares of residuals over noise, robust
  double noise = 0;            ///< N, that the residuals were divided by
  bool converged = false;
  std::string reason;  ///< if not converged
};

/// Minimises sum rho((force - model) / noise) with Cauchy's loss, which takes away the weight of
/// outliers, by Ceres's trust region. `held`: indices of unknowns that stay as they are.
CurveFit fitCurve(CurveModel& model, const Eigen::VectorXd& start, double noise, const std::vector<int>& held = {});

/// Fits, takes the noise from the residuals, and fits again.
CurveFit fitCurveAndNoise(CurveModel& model, double noise);

/// Number of samples over that of independent ones: 1 for white residuals, more for residuals that
/// follow each other (integrated autocorrelation, Sokal's window).
double correlationLength(const Eigen::VectorXd& residuals);

}  // namespace microinjection
