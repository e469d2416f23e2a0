#include "vision/calibration/calibration_fit.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "vision/calibration/play.h"

namespace microinjection {
namespace {

constexpr double kLeastLimit = 1e-3;       ///< stated deviations, an outlier of observations without noise
constexpr double kOutlyingReading = 1e-5;  ///< of a good focus reading
constexpr double kLoss = 2;                ///< deviations, scale of Cauchy's loss

bool isPositive(int parameter) { return parameter == kPixelSize || parameter == kAxisRatio; }

/// Ceres sees parameters of about 1: micrometres instead of metres. What must stay positive is a
/// logarithm.
CalibrationVector<double> units() {
  CalibrationVector<double> unit = CalibrationVector<double>::Ones();
  for (const int i : {kPixelSize, kBacklashX, kBacklashY, kBacklashZ, kFocusZero}) unit[i] = 1e-6;
  return unit;
}

template <typename T>
CalibrationVector<T> valueOf(const T* scaled) {
  using std::exp;
  static const CalibrationVector<double> kUnits = units();
  CalibrationVector<T> value;
  for (int i = 0; i < kCalibrationParameters; ++i) {
    value[i] = T(kUnits[i]) * (isPositive(i) ? exp(scaled[i]) : scaled[i]);
  }
  return value;
}

CalibrationVector<double> scaledOf(const CalibrationVector<double>& value) {
  CalibrationVector<double> scaled = value.cwiseQuotient(units());
  for (const int i : {kPixelSize, kAxisRatio}) scaled[i] = std::log(scaled[i]);
  return scaled;
}

double plain(double value) { return value; }
template <typename T, int N>
double plain(const ceres::Jet<T, N>& value) {
  return value.a;
}

/// Offset (m) of the tip from the origin at waypoint `index`, after the play of all moves up to it.
template <typename T>
Eigen::Matrix<T, 3, 1> offsetAt(const CalibrationData& data, int index, const CalibrationVector<T>& p) {
  Eigen::Matrix<T, 3, 1> offset;
  for (int i = 0; i < 3; ++i) {
    const T half = T(0.5) * p[kBacklashX + i];
    PlayAxis axis{data.waypoints.front().position[i], 1};
    for (int k = 1; k <= index; ++k) {
      axis.move(data.waypoints[k - 1].position[i], data.waypoints[k].position[i], plain(half));
    }
    offset[i] = T(axis.anchor - data.origin[i]) - T(axis.side) * half;
  }
  return offset;
}

Eigen::Matrix2d whitening(const Eigen::Matrix2d& covariance) {
  return covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
}

struct PixelCost {
  const CalibrationData& data;
  int index;
  bool mirrored;
  Eigen::Matrix2d weight;

  template <typename T>
  bool operator()(const T* scaled, T* residual) const {
    const CalibrationVector<T> p = valueOf(scaled);
    const Eigen::Matrix<T, 2, 1> seen = data.waypoints[index].pixel->cast<T>();
    Eigen::Map<Eigen::Matrix<T, 2, 1>> result(residual);
    result = weight.cast<T>() * (tipPixel<T>(p, mirrored, offsetAt(data, index, p)) - seen);
    return true;
  }
};

struct FocusCost {
  const CalibrationData& data;
  int index;
  double weight;  ///< 1/m

  template <typename T>
  bool operator()(const T* scaled, T* residual) const {
    const CalibrationVector<T> p = valueOf(scaled);
    *residual = T(weight) * (tipFocus<T>(p, offsetAt(data, index, p)) - T(*data.waypoints[index].focus));
    return true;
  }
};

int countOf(const std::vector<bool>& used) { return static_cast<int>(std::count(used.begin(), used.end(), true)); }

}  // namespace

/// The problem that Ceres solves, over the used observations.
struct CalibrationFit::Problem {
  Problem(const CalibrationFit& fit, bool robust) {
    scaled = scaledOf(fit.value_);
    const auto loss = [robust]() -> ceres::LossFunction* { return robust ? new ceres::CauchyLoss(kLoss) : nullptr; };
    const CalibrationData& data = fit.data_;
    for (std::size_t k = 0; k < data.pixels.size(); ++k) {
      if (!fit.use_pixel_[k]) continue;
      const int index = data.pixels[k];
      const Eigen::Matrix2d weight = whitening(fit.pixel_factor_ * data.waypoints[index].covariance);
      auto* cost = new PixelCost{data, index, fit.mirrored_, weight};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PixelCost, 2, kCalibrationParameters>(cost), loss(),
                               scaled.data());
    }
    for (std::size_t k = 0; k < data.focus.size(); ++k) {
      if (!fit.use_focus_[k]) continue;
      const int index = data.focus[k];
      const double deviation = std::sqrt(fit.focus_factor_) * data.waypoints[index].focus_deviation;
      auto* cost = new FocusCost{data, index, 1 / deviation};
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<FocusCost, 1, kCalibrationParameters>(cost), loss(),
                               scaled.data());
    }
    std::vector<int> fixed;
    for (int i = 0; i < kCalibrationParameters; ++i) {
      if (!data.estimated[i]) fixed.push_back(i);
    }
    if (!fixed.empty()) {
      problem.SetManifold(scaled.data(), new ceres::SubsetManifold(kCalibrationParameters, fixed));
    }
  }

  CalibrationVector<double> scaled;
  ceres::Problem problem;
};

CalibrationFit::CalibrationFit(const CalibrationData& data, const CalibrationStart& start)
    : data_(data),
      mirrored_(start.mirrored),
      value_(start.value),
      use_pixel_(data.pixels.size(), true),
      use_focus_(data.focus.size(), true) {}

bool CalibrationFit::solve(bool robust) {
  Problem problem(*this, robust);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-11;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem, &summary);
  if (!summary.IsSolutionUsable() || !problem.scaled.allFinite()) return false;
  value_ = valueOf(problem.scaled.data());
  return value_.allFinite();
}

Eigen::Vector2d CalibrationFit::pixelError(std::size_t k) const {
  const int index = data_.pixels[k];
  return tipPixel<double>(value_, mirrored_, offsetAt(data_, index, value_)) - *data_.waypoints[index].pixel;
}

double CalibrationFit::focusError(std::size_t k) const {
  const int index = data_.focus[k];
  return tipFocus<double>(value_, offsetAt(data_, index, value_)) - *data_.waypoints[index].focus;
}

double CalibrationFit::pixelNorm(std::size_t k) const {
  return (whitening(data_.waypoints[data_.pixels[k]].covariance) * pixelError(k)).norm();
}

double CalibrationFit::focusNorm(std::size_t k) const {
  return std::abs(focusError(k)) / data_.waypoints[data_.focus[k]].focus_deviation;
}

int CalibrationFit::focusFreedom() const {
  int parameters = 0;
  for (const int i : {kBacklashY, kFocusX, kFocusY, kFocusZ, kFocusZero}) parameters += data_.estimated[i] ? 1 : 0;
  return countOf(use_focus_) - parameters;
}

int CalibrationFit::freedom() const {
  int parameters = 0;
  for (int i = 0; i < kFocusX; ++i) parameters += data_.estimated[i] && i != kBacklashY ? 1 : 0;
  return 2 * countOf(use_pixel_) - parameters;
}

bool CalibrationFit::flagOutliers() {
  std::vector<bool> pixels(use_pixel_.size(), true), focus(use_focus_.size(), true);
  std::vector<double> norms, readings;
  for (std::size_t k = 0; k < pixels.size(); ++k) norms.push_back(pixelNorm(k));
  for (std::size_t k = 0; k < focus.size(); ++k) readings.push_back(focusNorm(k));
  // The parameters take up a part of the residuals, as in an unbiased variance.
  const double share = 2.0 * countOf(use_pixel_) / std::max(1, freedom());
  const double limit = kOutlierDeviations * medianOf(norms) / kRayleighMedian * std::sqrt(share);
  for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] = norms[k] <= std::max(kLeastLimit, limit);
  if (!readings.empty() && focusFreedom() > 0) {
    const double focus_share = static_cast<double>(countOf(use_focus_)) / focusFreedom();
    const double deviation = 1.4826 * medianOf(readings) * std::sqrt(focus_share);
    const double focus_limit = studentLimit(1 - kOutlyingReading, focusFreedom()) * deviation;
    for (std::size_t k = 0; k < focus.size(); ++k) focus[k] = readings[k] <= std::max(kLeastLimit, focus_limit);
  }
  const bool changed = pixels != use_pixel_ || focus != use_focus_;
  use_pixel_ = pixels;
  use_focus_ = focus;
  return changed;
}

void CalibrationFit::scaleByResiduals() {
  // Noise-free observations would give infinite weights.
  constexpr double kLeastFactor = 1e-12;
  double pixel_sum = 0, focus_sum = 0;
  for (std::size_t k = 0; k < use_pixel_.size(); ++k) pixel_sum += use_pixel_[k] ? std::pow(pixelNorm(k), 2) : 0;
  for (std::size_t k = 0; k < use_focus_.size(); ++k) focus_sum += use_focus_[k] ? std::pow(focusNorm(k), 2) : 0;
  pixel_factor_ = std::max(kLeastFactor, pixel_sum / std::max(1, freedom()));
  if (focusFreedom() > 0) focus_factor_ = std::max(kLeastFactor, focus_sum / focusFreedom());
}

bool CalibrationFit::covariance(Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters>& result) const {
  Problem problem(*this, false);
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks{{problem.scaled.data(), problem.scaled.data()}};
  if (!covariance.Compute(blocks, &problem.problem)) return false;
  Eigen::Matrix<double, kCalibrationParameters, kCalibrationParameters, Eigen::RowMajor> scaled;
  if (!covariance.GetCovarianceBlock(problem.scaled.data(), problem.scaled.data(), scaled.data())) return false;
  CalibrationVector<double> unit = units();
  for (const int i : {kPixelSize, kAxisRatio}) unit[i] = value_[i];
  result = unit.asDiagonal() * scaled * unit.asDiagonal();
  result = (0.5 * (result + result.transpose())).eval();
  return result.allFinite();
}

double CalibrationFit::residual() const {
  double sum = 0;
  for (std::size_t k = 0; k < use_pixel_.size(); ++k) sum += use_pixel_[k] ? pixelError(k).squaredNorm() : 0;
  return std::sqrt(sum / std::max(1, freedom()));
}

double CalibrationFit::focusResidual() const {
  double sum = 0;
  for (std::size_t k = 0; k < use_focus_.size(); ++k) sum += use_focus_[k] ? std::pow(focusError(k), 2) : 0;
  return std::sqrt(sum / std::max(1, focusFreedom()));
}

}  // namespace microinjection
