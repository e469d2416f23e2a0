#include "benchmark/common/kalman_estimator.h"

#include <cmath>
#include <vector>

namespace microinjection {
namespace {

constexpr int kReadings = 3;    // that become one sample: 60 nm at 20 um/s, as the estimator's spacing
constexpr int kIterations = 4;  // of an update
constexpr double kStep = 1e-3;  // deviations, for the derivatives
constexpr double kDeviations95 = 1.96;
constexpr double kDeviationOfMedian = 1.4826;

}  // namespace

KalmanEstimator::KalmanEstimator(const Scene& prior, const std::shared_ptr<const SurrogateData>& cell,
                                 const CellEstimatorConfig& config)
    : config_(config), prior_modulus_(prior.cell.material().young_modulus), path_(prior, cell) {}

double KalmanEstimator::modulus() const { return prior_modulus_ * std::exp(config_.modulus_deviation * state_[0]); }

double KalmanEstimator::deviation() const { return config_.modulus_deviation * std::sqrt(covariance_(0, 0)); }

bool KalmanEstimator::covers(double other, double law_error) const {
  return std::abs(std::log(other / modulus())) <=
         kDeviations95 * std::hypot(deviation(), kDeviationOfMedian * law_error);
}

double KalmanEstimator::force(const Eigen::Vector3d& tip, const Eigen::Vector3d& state) {
  SampleHistory::Sample sample;
  sample.tip = tip;
  std::vector<ForcePath::Point> points;
  path_.predict({sample}, config_.contact_deviation * state[1], points);
  return std::exp(config_.modulus_deviation * state[0]) * points[0].force + config_.offset_deviation * state[2];
}

void KalmanEstimator::add(double time, const Eigen::Vector3d& tip, double force) {
  if (filter_.judge(time, force, config_.sensor_noise) != ReadingFilter::Verdict::kGood) return;
  tips_ += tip;
  forces_ += force;
  if (++waiting_ < kReadings) return;
  update(tips_ / waiting_, forces_ / waiting_, waiting_);
  tips_.setZero();
  forces_ = 0;
  waiting_ = 0;
}

/// Gauss-Newton about the predicted state, which is that of before: the cell does not change.
void KalmanEstimator::update(const Eigen::Vector3d& tip, double measured, int readings) {
  Eigen::Vector3d state = state_, gain = Eigen::Vector3d::Zero();
  Eigen::RowVector3d slope = Eigen::RowVector3d::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double predicted = force(tip, state);
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d beside = state;
      beside[i] += kStep;
      slope[i] = (force(tip, beside) - predicted) / kStep;
    }
    const double noise = std::hypot(config_.sensor_noise / std::sqrt(readings),
                                    std::hypot(config_.sensor_floor, config_.force_error * predicted));
    gain = covariance_ * slope.transpose() / (slope * covariance_ * slope.transpose() + noise * noise);
    state = state_ + gain * (measured - predicted - slope * (state_ - state));
  }
  state_ = state;
  covariance_ = (Eigen::Matrix3d::Identity() - gain * slope) * covariance_;
}

}  // namespace microinjection
