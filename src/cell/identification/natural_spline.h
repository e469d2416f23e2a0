#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Second derivatives at the knots of the natural cubic spline (zero at both ends). @pre x ascends
Eigen::VectorXd naturalSplineCurvature(const Eigen::VectorXd& x, const Eigen::VectorXd& y);

struct SplineValue {
  double value = 0, slope = 0;
};

/// The spline at a place; beyond its ends it goes on as a straight line.
SplineValue naturalSpline(const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& curvature,
                          double at);

}  // namespace microinjection
