#include "cell/estimation/cell_estimator.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "cell/identification/curve_fit.h"

namespace microinjection {
namespace {

constexpr char kUntouched[] = "the needle has not touched the cell";
constexpr char kOnlySeen[] = "images show the contact only: without a force nothing is known of the modulus";

constexpr int kIterations = 6;
constexpr double kOutlier = 3;        ///< residual over its deviation from which a sample loses weight
constexpr double kHeightStep = 5e-9;  ///< m, of the contact's height, for the derivative
constexpr double kSmall = 1e-3;       ///< change of the state, in deviations, that ends the fit
constexpr double kDeviations95 = 1.96;
constexpr double kDeviationOfMedian = 1.4826;
constexpr double kLearned = 0.5;          ///< of the prior's variance: with more left, nothing was learned
constexpr double kConflict = 3;           ///< of the prior's deviations, from what was learned of a cell before
constexpr int kContradictingUpdates = 3;  ///< updates in a row that must contradict
constexpr double kSignificant = 4;        ///< of a smooth residual, over what noise leaves of it
constexpr double kApproach = 1.0;         ///< s before the contact that are kept, for the offset

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

CellEstimator::CellEstimator(const Scene& scene, std::shared_ptr<const SurrogateData> cell,
                             const CellEstimatorConfig& config, std::shared_ptr<const std::vector<RivalCell>> rivals)
    : config_(config),
      scene_modulus_(scene.cell.material().young_modulus),
      law_error_(cell->median_error),
      prior_modulus_(scene_modulus_),
      prior_deviation_(config.modulus_deviation),
      path_(scene, cell),
      shifted_(scene, cell),
      history_(config.history),
      watch_(scene, cell, std::move(rivals), {config.contact_deviation, config.offset_deviation, config.sensor_floor}) {
  setPrior(EstimateVerdict::kPrior, kUntouched);
}

void CellEstimator::beginNext() {
  const bool known =
      estimate_.verdict == EstimateVerdict::kLearning || estimate_.verdict == EstimateVerdict::kConverged;
  if (known) {
    prior_modulus_ = estimate_.modulus;
    prior_deviation_ = std::max(config_.next_deviation, std::sqrt(estimate_.covariance(0, 0)));
  } else if (estimate_.verdict == EstimateVerdict::kInconsistent) {
    prior_modulus_ = scene_modulus_;
    prior_deviation_ = config_.modulus_deviation;
  }
  history_.clear();
  state_.setZero();
  contradictions_ = 0;
  filter_.reset();
  watch_.reset();
  setPrior(EstimateVerdict::kPrior, kUntouched);
}

double CellEstimator::noise() const {
  const double known = history_.noise();
  return known > 0 ? known : config_.sensor_noise;
}

double CellEstimator::modulusOf(const State& state) const {
  return prior_modulus_ * std::exp(prior_deviation_ * state[0]);
}

void CellEstimator::setPrior(EstimateVerdict verdict, const std::string& reason) {
  estimate_ = {};
  estimate_.verdict = verdict;
  estimate_.reason = reason;
  // A contradiction takes away what was estimated of a cell before, too.
  const bool contradicted = verdict == EstimateVerdict::kInconsistent;
  const double deviation = contradicted ? config_.modulus_deviation : prior_deviation_;
  const double factor = std::exp(kDeviations95 * deviation);
  estimate_.modulus = contradicted ? scene_modulus_ : prior_modulus_;
  estimate_.modulus_low = estimate_.modulus / factor;
  estimate_.modulus_high = estimate_.modulus * factor;
  estimate_.covariance =
      Eigen::Vector3d(deviation, config_.contact_deviation, config_.offset_deviation).cwiseAbs2().asDiagonal();
  estimate_.contact = config_.contact_deviation * prior_.mean[1];
  estimate_.covariance(1, 1) /= prior_.precision[1];
}

void CellEstimator::seeContact(const std::optional<ImageContact::Height>& seen) {
  prior_ = {};
  if (seen) {
    const double information = std::pow(config_.contact_deviation / seen->deviation, 2);
    prior_.precision[1] += information;
    prior_.mean[1] = information / prior_.precision[1] * seen->value / config_.contact_deviation;
  }
  const bool unfelt = history_.samples().empty() && estimate_.verdict == EstimateVerdict::kPrior;
  if (unfelt) setPrior(EstimateVerdict::kPrior, seen ? kOnlySeen : kUntouched);
}

std::string CellEstimator::add(double time, const Eigen::Vector3d& tip, double force) {
  const double noise = std::max(config_.sensor_noise, history_.noise());
  if (filter_.judge(time, force, noise) == ReadingFilter::Verdict::kGood) history_.add(time, tip, force);
  return filter_.complaint();
}

void CellEstimator::forgetSince(double time) {
  history_.forgetSince(time);
  contradictions_ = 0;  // it may have been of these readings
  watch_.reset();
  update();
}

bool CellEstimator::Fit::touches() const {
  return std::any_of(points.begin(), points.end(), [](const auto& point) { return point.touches; });
}

/// Deviations: the sensor's and, of the last state's force, the model's.
void CellEstimator::linearise(const State& state, Fit& fit, Eigen::MatrixXd& jacobian) {
  const auto& samples = history_.samples();
  const double shift = config_.contact_deviation * state[1];
  const double factor = modulusOf(state) / scene_modulus_;
  path_.predict(samples, shift, fit.points);
  shifted_.predict(samples, shift + kHeightStep, shifted_points_);
  const double noise = this->noise();
  const auto count = static_cast<Eigen::Index>(samples.size());
  fit.state = state;
  fit.residuals.resize(count);
  fit.deviations.resize(count);
  jacobian.resize(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double force = factor * fit.points[k].force;
    const double deviation = std::hypot(noise / std::sqrt(samples[k].readings),
                                        std::hypot(config_.sensor_floor, config_.force_error * force));
    fit.deviations[i] = deviation;
    if (!fit.points[k].prepared) {  // there is no prediction to learn from
      fit.residuals[i] = 0;
      jacobian.row(i).setZero();
      continue;
    }
    fit.residuals[i] = (samples[k].force - force - config_.offset_deviation * state[2]) / deviation;
    jacobian(i, 0) = prior_deviation_ * force / deviation;
    jacobian(i, 1) =
        config_.contact_deviation * factor * (shifted_points_[k].force - fit.points[k].force) / kHeightStep / deviation;
    jacobian(i, 2) = config_.offset_deviation / deviation;
  }
}

double CellEstimator::cost(const Fit& fit, double scale) const {
  const double square = scale * scale;
  return 0.5 * square * (fit.residuals.array().square() / square).log1p().sum() + prior_.cost(fit.state);
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
    best.normal = jacobian.transpose() * weights.asDiagonal() * jacobian;
    best.normal.diagonal() += prior_.precision;
    const State right = jacobian.transpose() * weights.cwiseProduct(best.residuals) -
                        prior_.precision.cwiseProduct(best.state - prior_.mean);
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
    beginNext();
    return estimate_;
  }
  state_ = fit.state;
  if (std::abs(state_[0]) > kConflict && prior_deviation_ < config_.modulus_deviation) {
    // It is not the cell of before: the prior is as wide as for an unknown one.
    state_[0] *= prior_deviation_ / config_.modulus_deviation;
    prior_deviation_ = config_.modulus_deviation;
    return update();
  }
  judge(fit);
  if (!fit.touches()) history_.forgetBefore(history_.samples().back().time - kApproach);
  return estimate_;
}

void CellEstimator::judge(const Fit& fit) {
  // A contradiction stays until the next indentation: the served cell must not go to and fro.
  if (contradictions_ == kContradictingUpdates) return;
  const std::string reason = drift(fit);
  if (!reason.empty()) return setPrior(EstimateVerdict::kPrior, reason);
  const Misfit misfit = misfitOf(fit.points, modulusOf(fit.state) / scene_modulus_,
                                 fit.residuals.cwiseProduct(fit.deviations), fit.deviations);
  contradictions_ = contradicts(misfit) ? contradictions_ + 1 : 0;
  if (contradictions_ < kContradictingUpdates) {
    estimate_ = estimateOf(fit, misfit);
    const std::string& better = watch_.follow(
        history_.samples(), noise(), {estimate_.modulus, estimate_.contact, estimate_.offset, estimate_.depth});
    if (better.empty()) return;
    contradictions_ = kContradictingUpdates;
    return setPrior(EstimateVerdict::kInconsistent, "another cell has this force rather than this model: " + better);
  }
  char text[120];
  std::snprintf(text, sizeof(text), "the force differs from this model's by %.2g %% of it, smoothly over the depth",
                100 * misfit.found);
  setPrior(EstimateVerdict::kInconsistent, text);
}

bool CellEstimator::contradicts(const Misfit& misfit) const {
  return misfit.found > config_.misfit && misfit.found > kSignificant * misfit.expected;
}

std::string CellEstimator::drift(const Fit& fit) const {
  // The samples at the tail of the approach may already feel a cell that is higher than modelled.
  const double margin = 3 * config_.contact_deviation;
  const SensorDrift drift = driftBeforeContact(history_.samples(), fit.points, margin, fit.deviations);
  if (std::abs(drift.rate) <= config_.drift_limit + 3 * drift.deviation) return "";
  char text[120];
  std::snprintf(text, sizeof(text), "the sensor drifts by %.2g nN/s before contact: allowed %.2g", 1e9 * drift.rate,
                1e9 * config_.drift_limit);
  return text;
}

CellEstimate CellEstimator::estimateOf(const Fit& fit, const Misfit& misfit) const {
  // Residuals that follow each other say less than their number.
  const double correlation = correlationLength(fit.residuals);
  const Eigen::Vector3d units(prior_deviation_, config_.contact_deviation, config_.offset_deviation);
  const Eigen::Matrix3d prior = prior_.precision.asDiagonal();
  const Eigen::Matrix3d information = (fit.normal - prior) / correlation + prior;
  const Eigen::Matrix3d covariance = information.inverse();
  CellEstimate next;
  next.covariance = units.asDiagonal() * covariance * units.asDiagonal();
  next.covariance(0, 0) += std::pow(kDeviationOfMedian * law_error_, 2);
  const double half = kDeviations95 * std::sqrt(next.covariance(0, 0));
  next.modulus = modulusOf(fit.state);
  next.modulus_low = next.modulus * std::exp(-half);
  next.modulus_high = next.modulus * std::exp(half);
  next.contact = units[1] * fit.state[1];
  next.offset = units[2] * fit.state[2];
  next.misfit = misfit.found;
  for (const ForcePath::Point& point : fit.points) {
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
  }
  return next;
}

void CellEstimatorConfig::read(ConfigReader& reader) {
  reader.number("modulus_deviation", modulus_deviation, Range::closed(0.01, 3));
  reader.number("next_deviation", next_deviation, Range::closed(0.01, 3));
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

}  // namespace microinjection
