#include "cell/estimation/cell_estimator.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cell/identification/curve_fit.h"

namespace microinjection {
namespace {

constexpr int kIterations = 6;
constexpr double kOutlier = 3;   ///< residual over its deviation from which a sample loses weight
constexpr double kStep = 5e-9;   ///< m, of the contact's height, for the derivative
constexpr double kSmall = 1e-3;  ///< change of the state, in deviations, that ends the fit
constexpr double kDeviations95 = 1.96;
constexpr double kDeviationOfMedian = 1.4826;
constexpr double kLearned = 0.5;  ///< of the prior's variance: with more left, nothing was learned
constexpr int kFewest = 24;       ///< samples in contact, of a contradiction
constexpr int kBlocks = 8;
constexpr int kPersistent = 3;      ///< updates in a row that must contradict
constexpr double kSignificant = 4;  ///< of a smooth residual, over what noise leaves of it
constexpr double kFarOff = 6;       ///< of a reading from its neighbours, over the noise
constexpr int kFrozen = 20;         ///< equal readings: a sensor that hangs
constexpr double kApproach = 1.0;   ///< s before the contact that are kept, for the offset
constexpr double kFewestFree = 12;  ///< samples before contact from which a drift is judged

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

const char* toText(EstimateVerdict verdict) {
  switch (verdict) {
    case EstimateVerdict::kPrior:
      return "prior";
    case EstimateVerdict::kLearning:
      return "learning";
    case EstimateVerdict::kConverged:
      return "converged";
    case EstimateVerdict::kInconsistent:
      break;
  }
  return "inconsistent";
}

void CellEstimatorConfig::read(ConfigReader& reader) {
  reader.number("modulus_deviation", modulus_deviation, Range::closed(0.01, 3));
  reader.number("contact_deviation", contact_deviation, Range::closed(1e-9, 20e-6));
  reader.number("offset_deviation", offset_deviation, Range::positive());
  reader.number("sensor_noise", sensor_noise, Range::positive());
  reader.number("sensor_floor", sensor_floor, Range::positive());
  reader.number("force_error", force_error, Range::closed(0, 0.2));
  reader.number("converged_interval", converged_interval, Range::closed(0.001, 0.5));
  reader.number("misfit", misfit, Range::closed(0.001, 1));
  reader.number("drift_limit", drift_limit, Range::positive());
  ConfigReader samples = reader.section("history");
  history.read(samples);
}

CellEstimator::CellEstimator(const Scene& scene, std::shared_ptr<const SurrogateData> cell,
                             const CellEstimatorConfig& config)
    : config_(config),
      prior_modulus_(scene.cell.material().young_modulus),
      law_error_(cell->median_error),
      path_(scene, cell),
      shifted_(scene, cell),
      history_(config.history) {
  setPrior(EstimateVerdict::kPrior, "the needle has not touched the cell");
}

void CellEstimator::reset() {
  history_.clear();
  state_.setZero();
  contradictions_ = repeated_ = 0;
  received_ = 0;
  setPrior(EstimateVerdict::kPrior, "the needle has not touched the cell");
}

void CellEstimator::setPrior(EstimateVerdict verdict, const std::string& reason) {
  estimate_ = {};
  estimate_.verdict = verdict;
  estimate_.reason = reason;
  const double factor = std::exp(kDeviations95 * config_.modulus_deviation);
  estimate_.modulus = prior_modulus_;
  estimate_.modulus_low = prior_modulus_ / factor;
  estimate_.modulus_high = prior_modulus_ * factor;
  estimate_.covariance = Eigen::Vector3d(config_.modulus_deviation, config_.contact_deviation, config_.offset_deviation)
                             .cwiseAbs2()
                             .asDiagonal();
}

void CellEstimator::add(double time, const Eigen::Vector3d& tip, double force) {
  const double last = window_[(received_ + kWindow - 1) % kWindow];
  repeated_ = received_ > 0 && force == last ? repeated_ + 1 : 0;
  window_[received_++ % kWindow] = force;
  if (repeated_ < kFrozen && !isOutlier(force)) history_.add(time, tip, force);
}

bool CellEstimator::isOutlier(double force) const {
  if (received_ < kWindow) return true;  // nobody knows
  std::array<double, kWindow> sorted = window_;
  std::nth_element(sorted.begin(), sorted.begin() + kWindow / 2, sorted.end());
  return std::abs(force - sorted[kWindow / 2]) > kFarOff * std::max(config_.sensor_noise, history_.noise());
}

/// Deviations: the sensor's and, of the last state's force, the model's.
void CellEstimator::linearise(const State& state, Fit& fit, Eigen::MatrixXd& jacobian) {
  const auto& samples = history_.samples();
  const double shift = config_.contact_deviation * state[1];
  const double factor = std::exp(config_.modulus_deviation * state[0]);
  path_.predict(samples, shift, points_);
  shifted_.predict(samples, shift + kStep, shifted_points_);
  const double known = history_.noise(), noise = known > 0 ? known : config_.sensor_noise;
  const auto count = static_cast<Eigen::Index>(samples.size());
  fit.state = state;
  fit.residuals.resize(count);
  fit.deviations.resize(count);
  jacobian.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double force = factor * points_[k].force;
    const double deviation = std::hypot(noise / std::sqrt(samples[k].readings),
                                        std::hypot(config_.sensor_floor, config_.force_error * force));
    fit.deviations[i] = deviation;
    if (!points_[k].prepared) {  // there is no prediction to learn from
      fit.residuals[i] = 0;
      jacobian.row(i).setZero();
      continue;
    }
    fit.residuals[i] = (samples[k].force - force - config_.offset_deviation * state[2]) / deviation;
    jacobian(i, 0) = config_.modulus_deviation * force / deviation;
    jacobian(i, 1) =
        config_.contact_deviation * factor * (shifted_points_[k].force - points_[k].force) / kStep / deviation;
    jacobian(i, 2) = config_.offset_deviation / deviation;
  }
}

double CellEstimator::cost(const Fit& fit, double scale) const {
  const double square = scale * scale;
  return 0.5 * square * (fit.residuals.array().square() / square).log1p().sum() + 0.5 * fit.state.squaredNorm();
}

/// The weights' scale falls with the residuals: far from the solution all samples are far off, and
/// none of them is an outlier.
CellEstimator::Fit CellEstimator::fit(const State& start) {
  Fit best;
  Eigen::MatrixXd jacobian, next_jacobian;
  linearise(start, best, jacobian);
  double damping = 1e-6;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::vector<double> sizes(static_cast<std::size_t>(best.residuals.size()));
    Eigen::VectorXd::Map(sizes.data(), best.residuals.size()) = best.residuals.cwiseAbs();
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(0.9 * sizes.size()), sizes.end());
    const double scale = std::max(kOutlier, sizes[static_cast<std::size_t>(0.9 * sizes.size())]);
    const Eigen::VectorXd weights = (1 + (best.residuals.array() / scale).square()).inverse();
    best.normal = jacobian.transpose() * weights.asDiagonal() * jacobian + Eigen::Matrix3d::Identity();
    const State right = jacobian.transpose() * weights.cwiseProduct(best.residuals) - best.state;
    Eigen::Matrix3d damped = best.normal;
    damped.diagonal() *= 1 + damping;
    const State change = damped.ldlt().solve(right);
    if (change.cwiseAbs().maxCoeff() < kSmall) break;
    Fit next;
    linearise(best.state + change, next, next_jacobian);
    if (cost(next, scale) < cost(best, scale)) {
      next.normal = best.normal;
      best = std::move(next);
      jacobian.swap(next_jacobian);
      damping = std::max(1e-6, 0.1 * damping);
    } else {
      damping = std::max(1e-2, 10 * damping);
    }
  }
  return best;
}

const CellEstimate& CellEstimator::update() {
  if (history_.samples().empty()) return estimate_;
  const Fit fit = this->fit(state_);
  if (!fit.state.allFinite()) {
    reset();
    return estimate_;
  }
  state_ = fit.state;
  judge(fit);
  const bool touched = std::any_of(points_.begin(), points_.end(), [](const auto& point) { return point.touches; });
  if (!touched) history_.forgetBefore(history_.samples().back().time - kApproach);
  return estimate_;
}

void CellEstimator::judge(const Fit& fit) {
  const std::string drift = drifts();
  if (!drift.empty()) return setPrior(EstimateVerdict::kPrior, drift);
  const Misfit misfit = misfitOf(fit);
  contradictions_ = misfit.contradicts ? contradictions_ + 1 : 0;
  if (contradictions_ >= kPersistent) {
    char text[120];
    std::snprintf(text, sizeof(text), "the force differs from this model's by %.2g %% of it, smoothly over the depth",
                  100 * misfit.found);
    return setPrior(EstimateVerdict::kInconsistent, text);
  }

  // Residuals that follow each other say less than their number.
  const double correlation = correlationLength(fit.residuals);
  const Eigen::Vector3d units(config_.modulus_deviation, config_.contact_deviation, config_.offset_deviation);
  Eigen::Matrix3d information = (fit.normal - Eigen::Matrix3d::Identity()) / correlation + Eigen::Matrix3d::Identity();
  Eigen::Matrix3d covariance = information.inverse();
  CellEstimate next;
  next.covariance = units.asDiagonal() * covariance * units.asDiagonal();
  next.covariance(0, 0) += std::pow(kDeviationOfMedian * law_error_, 2);
  const double half = kDeviations95 * std::sqrt(next.covariance(0, 0));
  next.modulus = prior_modulus_ * std::exp(units[0] * fit.state[0]);
  next.modulus_low = next.modulus * std::exp(-half);
  next.modulus_high = next.modulus * std::exp(half);
  next.contact = units[1] * fit.state[1];
  next.offset = units[2] * fit.state[2];
  next.misfit = misfit.found;
  for (const ForcePath::Point& point : points_) {
    next.samples += point.touches;
    next.depth = std::max(next.depth, point.depth);
  }
  if (covariance(0, 0) > kLearned) {
    next.verdict = EstimateVerdict::kPrior;
    next.reason = "the force does not tell this cell's modulus yet";
  } else if (std::expm1(half) > config_.converged_interval) {
    next.verdict = EstimateVerdict::kLearning;
    next.reason = "the interval of the modulus is still wide";
  } else {
    next.verdict = EstimateVerdict::kConverged;
    next.reason = "";
  }
  estimate_ = next;
}

/// Of the blocks' medians of the residuals in contact.
CellEstimator::Misfit CellEstimator::misfitOf(const Fit& fit) const {
  std::vector<double> residuals, deviations;
  double largest = 0;
  const double factor = std::exp(config_.modulus_deviation * fit.state[0]);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    largest = std::max(largest, factor * points_[i].force);
    if (!points_[i].touches || !points_[i].prepared) continue;
    const auto k = static_cast<Eigen::Index>(i);
    residuals.push_back(fit.residuals[k] * fit.deviations[k]);
    deviations.push_back(fit.deviations[k]);
  }
  if (residuals.size() < kFewest || !(largest > 0)) return {};
  const std::size_t length = residuals.size() / kBlocks;
  double squares = 0, expected = 0;
  for (int block = 0; block < kBlocks; ++block) {
    const auto begin = static_cast<std::ptrdiff_t>(block * length), end = begin + static_cast<std::ptrdiff_t>(length);
    const double middle = median({residuals.begin() + begin, residuals.begin() + end});
    const double deviation = median({deviations.begin() + begin, deviations.begin() + end});
    squares += middle * middle;
    expected += deviation * deviation / static_cast<double>(length);
  }
  constexpr double kOfMedian = 1.25;  // deviation of a median over that of a mean
  Misfit misfit{std::sqrt(squares / kBlocks) / largest, kOfMedian * std::sqrt(expected / kBlocks) / largest};
  misfit.contradicts = misfit.found > config_.misfit && misfit.found > kSignificant * misfit.expected;
  return misfit;
}

std::string CellEstimator::drifts() const {
  double count = 0, time = 0, force = 0, times = 0, both = 0;
  const auto& samples = history_.samples();
  // The samples at the tail of the approach may already feel a cell that is higher than modelled.
  const double margin = 3 * config_.contact_deviation;
  const auto first = std::find_if(points_.begin(), points_.end(), [](const auto& point) { return point.touches; });
  const double surface =
      first == points_.end() ? -1e300 : samples[static_cast<std::size_t>(first - points_.begin())].tip.z();
  for (std::size_t i = 0; i < samples.size() && points_.begin() + static_cast<std::ptrdiff_t>(i) != first; ++i) {
    if (samples[i].tip.z() < surface + margin) continue;
    const double t = samples[i].time - samples.front().time, f = samples[i].force;
    ++count;
    time += t;
    force += f;
    times += t * t;
    both += t * f;
  }
  const double spread = times - time * time / std::max(count, 1.0);
  if (count < kFewestFree || !(spread > 0)) return "";
  const double rate = (both - time * force / count) / spread;
  const double deviation = config_.sensor_floor / std::sqrt(spread);
  if (std::abs(rate) < config_.drift_limit + 3 * deviation) return "";
  char text[120];
  std::snprintf(text, sizeof(text), "the sensor drifts by %.2g nN/s before contact: allowed %.2g", 1e9 * rate,
                1e9 * config_.drift_limit);
  return text;
}

}  // namespace microinjection
