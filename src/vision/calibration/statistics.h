#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/median.h"

namespace microinjection {

/// Two-sided interval of a value.
struct Interval {
  double low = 0;
  double high = 0;
  bool contains(double value) const { return low <= value && value <= high; }
  double half() const { return 0.5 * (high - low); }
};

/// Confidence of the intervals that are stated.
constexpr double kIntervalConfidence = 0.95;
/// Robust deviations beyond which a tip is an outlier; 4 of 100 000 good tips lie beyond.
constexpr double kOutlierDeviations = 4.5;
/// Median of the norm of two standard normal values.
constexpr double kRayleighMedian = 1.1774;

/// The t that |T| stays below with probability `confidence`, T of Student's distribution with
/// `freedom` (>= 1) degrees of freedom.
double studentLimit(double confidence, double freedom);
/// The f that Fisher's F(n, m) stays below with probability `confidence`.
double fisherLimit(double confidence, double n, double m);

/// 1.4826 times the median of the distances from the median: the deviation of normal values,
/// unmoved by fewer than half of outliers. @pre not empty
double robustDeviation(const std::vector<double>& values);

/// Whether a covariance is finite, symmetric and positive definite.
bool isCovariance(const Eigen::MatrixXd& matrix);

/// Solves regressors * solution = observed with the least sum of the rows' distances (of absolute
/// values for one column), by iteratively reweighted least squares. A few outliers hardly move it.
/// Empty when the regressors are dependent.
Eigen::MatrixXd leastDistances(const Eigen::MatrixXd& regressors, const Eigen::MatrixXd& observed, int iterations);

}  // namespace microinjection
