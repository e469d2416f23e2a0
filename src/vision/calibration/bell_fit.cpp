#include "vision/calibration/bell_fit.h"

#include <ceres/ceres.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr int kParameters = BellFit::kParameters;
constexpr double kFarthest = 1000, kNarrowest = 0.2, kWidest = 1000;  ///< planes, of middle and width
constexpr double kOutlyingPlane = 1e-4;

struct BellCost {
  BellPoint point;
  template <typename T>
  bool operator()(const T* p, T* residual) const {
    using std::exp;
    const T distance = (T(point.height) - p[2]) * exp(-p[3]);
    *residual = p[0] + p[1] * exp(T(-0.5) * distance * distance) - T(point.sharpness);
    return true;
  }
};

double errorOf(const BellPoint& point, const Bell& bell) {
  double error = 0;
  BellCost{point}(bell.data(), &error);
  return error;
}

/// Fits the used points; returns whether it converged.
bool fitUsed(const std::vector<BellPoint>& points, double loss, Bell& bell) {
  ceres::Problem problem;
  for (const BellPoint& point : points) {
    if (!point.used) continue;
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<BellCost, 1, kParameters>(new BellCost{point}),
                             loss > 0 ? new ceres::CauchyLoss(loss) : nullptr, bell.data());
  }
  // Beyond these the bell is a line or a single plane, and its middle is not determined.
  problem.SetParameterLowerBound(bell.data(), 2, -kFarthest);
  problem.SetParameterUpperBound(bell.data(), 2, kFarthest);
  problem.SetParameterLowerBound(bell.data(), 3, std::log(kNarrowest));
  problem.SetParameterUpperBound(bell.data(), 3, std::log(kWidest));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() && bell.allFinite() && bell[1] > 0;
}

double robustScale(const std::vector<BellPoint>& points, const Bell& bell) {
  std::vector<double> errors;
  for (const BellPoint& point : points) errors.push_back(std::abs(errorOf(point, bell)));
  const auto n = static_cast<double>(points.size());
  return 1.4826 * medianOf(errors) * std::sqrt(n / (n - kParameters));
}

/// Sums of the residuals and the covariance of the middle.
void finish(const std::vector<BellPoint>& points, BellFit& result) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (const BellPoint& point : points) {
    if (!point.used) continue;
    using Jet = ceres::Jet<double, kParameters>;
    Jet p[kParameters], residual;
    for (int i = 0; i < kParameters; ++i) p[i] = Jet(result.bell[i], i);
    BellCost{point}(p, &residual);
    normal += residual.v * residual.v.transpose();
    result.squares += residual.a * residual.a;
    ++result.used;
  }
  const Eigen::FullPivLU<Eigen::Matrix4d> lu(normal);
  result.good = result.freedom() >= 2 && lu.isInvertible();
  if (!result.good) return;
  result.deviation = std::sqrt(lu.inverse()(2, 2) * result.squares / result.freedom());
}

}  // namespace

BellFit fitBell(std::vector<BellPoint>& points, double width) {
  BellFit result;
  result.bell << 0, 1, 0, std::log(width);
  constexpr double kStartLoss = 0.1;
  if (!fitUsed(points, kStartLoss, result.bell)) return result;
  const auto freedom = static_cast<double>(points.size()) - kParameters;
  const double limit = studentLimit(1 - kOutlyingPlane, freedom) * robustScale(points, result.bell);
  for (BellPoint& point : points) point.used = std::abs(errorOf(point, result.bell)) <= limit;
  if (std::count_if(points.begin(), points.end(), [](const BellPoint& p) { return p.used; }) < kParameters + 2)
    return result;
  if (!fitUsed(points, 0, result.bell)) return result;
  finish(points, result);
  return result;
}

bool bellIsNeeded(const std::vector<BellPoint>& points, const BellFit& result, double false_rate) {
  double sum = 0, squares = 0;
  for (const BellPoint& point : points) sum += point.used ? point.sharpness : 0;
  for (const BellPoint& point : points) squares += point.used ? std::pow(point.sharpness - sum / result.used, 2) : 0;
  constexpr double kMore = kParameters - 1;
  const double noise = std::max(result.squares / result.freedom(), 1e-300);
  return (squares - result.squares) / kMore / noise > fisherLimit(1 - false_rate, kMore, result.freedom());
}

}  // namespace microinjection
