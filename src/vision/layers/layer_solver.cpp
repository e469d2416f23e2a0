#include "vision/layers/layer_solver.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "vision/frame/robust_loss.h"
#include "vision/layers/zona_inner.h"

namespace microinjection {
namespace {

constexpr double kUsedInside = 12;   // px, of the samples inside of the ooplasm
constexpr double kOddSector = 2.2;   // of the median residual of a sector: something else is there
constexpr double kMostOfSample = 6;  // deviations, that one sample counts in its sector
constexpr double kUsualWidth = 2, kUsualBlur = 1.3, kWidthShare = 0.5;  // px; standard deviation over the value
constexpr double kSameWidth = 0.4;  // px, standard deviation of the difference of the zona's lines
constexpr double kLeastLineWidth = 0.5, kLeastLineBlur = 0.7;  // px
constexpr double kShowsBorder = 8;                             // px, of samples that show a border
constexpr double kSmallestStep = 2e-3;                         // px, of the borders, that goes on

/// Tukey's biweight.
double tukey(double d) { return std::abs(d) < 1 ? (1 - d * d) * (1 - d * d) : 0; }

/// Whether a sample between the borders tells nothing of them.
bool isFar(const Eigen::VectorXd& p, const LayerModel::Sample& sample) {
  const double outer = sample.harmonics.sum(p, LayerModel::kOuter, 5) - sample.place;
  const double inner = outer - sample.harmonics.sum(p, LayerModel::kThickness, 3);
  const double ooplasm = sample.ooplasm + sample.harmonics.sum(p, LayerModel::kOoplasm, 5) - sample.place;
  return outer > kShowsBorder && std::abs(inner) > kShowsBorder && ooplasm < -kShowsBorder - p[LayerModel::kRim];
}

constexpr double kBand = 8;  // px to both sides of a border, see misfit()

}  // namespace

LayerSolver::LayerSolver(const LayerSamples& samples, const Ellipse& ooplasm, double rim, int every,
                         const Eigen::VectorXd& near)
    : sectors_(samples.sectors()),
      radius_(0.5 * samples.base().meanDiameter()),
      widths_{kUsualWidth, kUsualWidth, std::max(rim, kUsualWidth), std::max(0.5 * rim, kUsualWidth), kUsualBlur} {
  for (int s = 0; s < samples.sectors(); s += every) {
    const double direction = samples.direction(s);
    const double place = ooplasm.reach(samples.base().centre, direction) - samples.radius(s);
    for (int i = 0; i < samples.columns(); ++i) {
      if (!samples.valid(s, i) || samples.place(i) < place - kUsedInside) continue;
      const LayerModel::Sample sample{LayerModel::Harmonics(direction), samples.place(i), samples.radius(s), place};
      if (near.size() > 0 && isFar(near, sample)) continue;
      points_.push_back({sample, samples.grey(s, i), s, samples.place(i) < place});
    }
  }
  weight_.assign(points_.size(), 1.0);
  residual_.assign(points_.size(), 0.0);
  trial_ = residual_;
}

Eigen::VectorXd LayerSolver::start(const LayerModel& model, double thickness, double shift) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(model.size());
  for (int i = 0; i < 5; ++i) parameters[LayerModel::kOuterLine + i] = widths_[i];
  // An ooplasm inside of a flank that was taken for it: the flank is then the outer end of its rim.
  parameters[LayerModel::kRim] = std::max(widths_[2], -shift);
  parameters[LayerModel::kThickness] = thickness;
  parameters[LayerModel::kOoplasm] = shift;
  weight_.assign(points_.size(), 1.0);
  for (int round = 0; round < 2; ++round) {
    solveAmplitudes(model, parameters);
    weigh(model, parameters);
  }
  return parameters;
}

void LayerSolver::solveAmplitudes(const LayerModel& model, Eigen::VectorXd& parameters) const {
  const int n = model.terms();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), row(n);
  for (int i = 0; i < n; ++i) matrix(i, i) = priorWeight(model, LayerModel::kShapes + i);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (weight_[i] == 0) continue;
    model.terms(parameters, points_[i].sample, row.data());
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(row, weight_[i]);
    right += weight_[i] * points_[i].grey * row;
  }
  parameters.tail(n) = matrix.selfadjointView<Eigen::Lower>().ldlt().solve(right);
}

void LayerSolver::rest(const LayerModel& model, const Eigen::VectorXd& parameters, std::vector<double>& rest) const {
  for (std::size_t i = 0; i < points_.size(); ++i)
    rest[i] = points_[i].grey - model.value(parameters, points_[i].sample);
}

double LayerSolver::weighted(const std::vector<double>& rest) const {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) sum += weight_[i] * rest[i] * rest[i];
  return sum;
}

void LayerSolver::weigh(const LayerModel& model, const Eigen::VectorXd& parameters) {
  rest(model, parameters, residual_);
  reweigh();
}

void LayerSolver::reweigh() {
  std::vector<double> out, in;
  for (std::size_t i = 0; i < points_.size(); ++i) (points_[i].inside ? in : out).push_back(std::abs(residual_[i]));
  scale_[0] = std::max(1.4826 * upperMedian(std::move(out)), 1e-4);
  scale_[1] = std::max(1.4826 * upperMedian(std::move(in)), scale_[0]);
  std::vector<double> sum(sectors_, 0.0), count(sectors_, 0.0), rms(sectors_, 1e9), seen;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double r = std::min(std::abs(residual_[i]) / scale_[points_[i].inside ? 1 : 0], kMostOfSample);
    sum[points_[i].sector] += r * r;
    count[points_[i].sector] += 1;
  }
  for (int s = 0; s < sectors_; ++s) {
    if (count[s] < 10) continue;
    rms[s] = std::sqrt(sum[s] / count[s]);
    seen.push_back(rms[s]);
  }
  const double usual = std::max(upperMedian(seen), 1e-9);
  int counted = 0;
  for (int s = 0; s < sectors_; ++s) {
    counted += rms[s] < 0.9 * kOddSector * usual ? 1 : 0;
    rms[s] = tukey(rms[s] / (kOddSector * usual));
  }
  used_ = static_cast<double>(counted) / std::max<double>(1, static_cast<double>(seen.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double scale = scale_[points_[i].inside ? 1 : 0];
    weight_[i] = rms[points_[i].sector] * tukey(residual_[i] / (RobustLoss::kTukey * scale)) / (scale * scale);
  }
}

double LayerSolver::chi2(const LayerModel& model, const Eigen::VectorXd& parameters) const {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (weight_[i] == 0) continue;
    const double rest = points_[i].grey - model.value(parameters, points_[i].sample);
    sum += weight_[i] * rest * rest;
  }
  return sum;
}

double LayerSolver::step(const LayerModel& model, Eigen::VectorXd& parameters, double& damping) {
  normal(model, parameters);
  for (int attempt = 0; attempt < 5; ++attempt) {
    Eigen::MatrixXd damped = matrix_;
    damped.diagonal() *= 1 + damping;
    Eigen::VectorXd next = parameters + damped.ldlt().solve(right_);
    for (int i = LayerModel::kOuterLine; i < LayerModel::kBlur; ++i) next[i] = std::max(next[i], kLeastLineWidth);
    next[LayerModel::kBlur] = std::max(next[LayerModel::kBlur], kLeastLineBlur);
    rest(model, next, trial_);
    if (weighted(trial_) + prior(model, next) < chi_) {
      const double change = (next - parameters).head(LayerModel::kOuterLine).norm();
      parameters = next;
      residual_.swap(trial_);
      damping = std::max(1e-6, 0.1 * damping);
      return change;
    }
    damping *= 10;
  }
  return -1;
}

void LayerSolver::iterate(const LayerModel& model, Eigen::VectorXd& parameters, int steps, bool renew) {
  double damping = 1e-2;
  for (int i = 0; i < steps; ++i) {
    // After a step the residuals are those of the new parameters.
    if (renew && i == 0) weigh(model, parameters);
    if (renew && i > 0) reweigh();
    if (step(model, parameters, damping) < kSmallestStep) break;
  }
}

std::vector<double> LayerSolver::scan(const LayerModel& model, const Eigen::VectorXd& parameters, double low,
                                      int count) const {
  const int n = model.terms(), m = static_cast<int>(model.innerTerms().size()), rest = n - m;
  // The inner border's terms change with the thickness; those of the others do not and come first.
  Eigen::VectorXd p = parameters, values(n), grey(static_cast<Eigen::Index>(points_.size()));
  Eigen::MatrixXd others(rest, grey.size()), inner(m, grey.size());
  Eigen::VectorXd weights(n);
  for (int term = 0, k = 0, j = rest; term < n; ++term) {
    const bool is_inner = std::count(model.innerTerms().begin(), model.innerTerms().end(), term) > 0;
    weights[is_inner ? j++ : k++] = priorWeight(model, LayerModel::kShapes + term);
  }
  for (Eigen::Index i = 0; i < grey.size(); ++i) {
    const Point& point = points_[static_cast<std::size_t>(i)];
    const double root = std::sqrt(weight_[static_cast<std::size_t>(i)]);
    model.terms(p, point.sample, values.data());
    for (int term = 0, k = 0; term < n; ++term) {
      const bool is_inner =
          std::find(model.innerTerms().begin(), model.innerTerms().end(), term) != model.innerTerms().end();
      if (!is_inner) others(k++, i) = root * values[term];
    }
    grey[i] = root * point.grey;
  }
  Eigen::MatrixXd matrix = weights.asDiagonal();
  matrix.topLeftCorner(rest, rest) += others * others.transpose();
  Eigen::VectorXd right(n);
  right.head(rest) = others * grey;
  const double base = right.head(rest).dot(matrix.topLeftCorner(rest, rest).ldlt().solve(right.head(rest)));
  std::vector<double> gains;
  for (int k = 0; k < count; ++k) {
    p[LayerModel::kThickness] = low + k;
    for (Eigen::Index i = 0; i < grey.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      model.innerTerms(p, points_[index].sample, std::sqrt(weight_[index]), inner.col(i).data());
    }
    matrix.bottomLeftCorner(m, rest) = inner * others.transpose();
    matrix.topRightCorner(rest, m) = matrix.bottomLeftCorner(m, rest).transpose();
    matrix.bottomRightCorner(m, m) = inner * inner.transpose();
    matrix.bottomRightCorner(m, m) += weights.tail(m).asDiagonal();
    right.tail(m) = inner * grey;
    gains.push_back(right.dot(matrix.ldlt().solve(right)) - base);
  }
  return gains;
}

Eigen::MatrixXd LayerSolver::covariance(const LayerModel& model, const Eigen::VectorXd& parameters) {
  weigh(model, parameters);
  normal(model, parameters);
  return correlated() * matrix_.ldlt().solve(Eigen::MatrixXd::Identity(matrix_.rows(), matrix_.cols()));
}

double LayerSolver::priorWeight(const LayerModel& model, int index) const {
  double deviation = 0;
  if (index >= LayerModel::kShapes)
    deviation = model.usualAmplitude(index - LayerModel::kShapes);
  else if (index >= LayerModel::kOuterLine)
    deviation = kWidthShare * widths_[index - LayerModel::kOuterLine];
  else if (index == LayerModel::kThickness + 1 || index == LayerModel::kThickness + 2)
    deviation = kZonaTilt * radius_;
  else if (index == LayerModel::kThickness && !model.hasInner())
    deviation = 1;
  return deviation > 0 ? 1 / (deviation * deviation) : 1e-9;
}

double LayerSolver::priorPlace(int index) const {
  return index >= LayerModel::kOuterLine && index < LayerModel::kShapes ? widths_[index - LayerModel::kOuterLine] : 0;
}

double LayerSolver::prior(const LayerModel& model, const Eigen::VectorXd& parameters) const {
  double sum = 0;
  for (int i = 0; i < model.size(); ++i) {
    if (i == LayerModel::kThickness) continue;
    const double d = parameters[i] - priorPlace(i);
    sum += priorWeight(model, i) * d * d;
  }
  const double difference = parameters[LayerModel::kInnerLine] - parameters[LayerModel::kOuterLine];
  return sum + difference * difference / (kSameWidth * kSameWidth);
}

void LayerSolver::normal(const LayerModel& model, const Eigen::VectorXd& parameters) {
  const int n = model.size();
  constexpr int kBatch = 128;
  matrix_ = Eigen::MatrixXd::Zero(n, n);
  right_ = Eigen::VectorXd::Zero(n);
  chi_ = prior(model, parameters);
  Eigen::VectorXd slope(n);
  Eigen::MatrixXd batch(n, kBatch);
  int filled = 0;
  const auto flush = [&] {
    matrix_.selfadjointView<Eigen::Lower>().rankUpdate(batch.leftCols(filled));
    filled = 0;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (weight_[i] == 0) continue;
    residual_[i] = points_[i].grey - model.value(parameters, points_[i].sample, slope);
    chi_ += weight_[i] * residual_[i] * residual_[i];
    right_ += weight_[i] * residual_[i] * slope;
    batch.col(filled++) = std::sqrt(weight_[i]) * slope;
    if (filled == kBatch) flush();
  }
  flush();
  matrix_ = Eigen::MatrixXd(matrix_.selfadjointView<Eigen::Lower>());
  for (int i = 0; i < n; ++i) {
    const double weight = priorWeight(model, i);
    matrix_(i, i) += weight;
    if (i != LayerModel::kThickness) right_[i] -= weight * (parameters[i] - priorPlace(i));
  }
  // Both lines of the zona are images of like borders.
  const double same = 1 / (kSameWidth * kSameWidth);
  const double difference = parameters[LayerModel::kInnerLine] - parameters[LayerModel::kOuterLine];
  for (const int i : {LayerModel::kOuterLine, LayerModel::kInnerLine}) {
    const int other = LayerModel::kOuterLine + LayerModel::kInnerLine - i;
    matrix_(i, i) += same;
    matrix_(i, other) -= same;
    right_[i] -= (i == LayerModel::kInnerLine ? 1 : -1) * same * difference;
  }
}

double LayerSolver::cost() const {
  double sum = 0;
  for (const Point& point : points_) sum += std::log(scale_[point.inside ? 1 : 0]);
  return sum;
}

double LayerSolver::correlated() const {
  double product = 0, square = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (points_[i].sector != points_[i - 1].sector) continue;
    product += std::sqrt(weight_[i] * weight_[i - 1]) * residual_[i] * residual_[i - 1];
    square += weight_[i] * residual_[i] * residual_[i];
  }
  const double correlation = square > 0 ? std::clamp(product / square, 0.0, 0.9) : 0;
  return (1 + correlation) / (1 - correlation);
}

double LayerSolver::misfit(const LayerModel& model, const Eigen::VectorXd& parameters, int border) const {
  constexpr int kBins = 2 * static_cast<int>(kBand) + 1, kHarmonics = 3;
  double sum[kBins][kHarmonics] = {}, weight[kBins] = {};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (weight_[i] == 0) continue;
    const LayerModel::Sample& sample = points_[i].sample;
    const double place = border == 0 ? sample.harmonics.sum(parameters, LayerModel::kOuter, 5)
                                     : sample.ooplasm + sample.harmonics.sum(parameters, LayerModel::kOoplasm, 5);
    const int bin = static_cast<int>(std::lround(sample.place - place + kBand));
    if (bin < 0 || bin >= kBins) continue;
    // Samples of the inside have more texture and less weight: here each counts by its sector alone.
    const double scale = scale_[points_[i].inside ? 1 : 0], share = weight_[i] * scale * scale;
    const double rest = share * (points_[i].grey - model.value(parameters, sample));
    for (int k = 0; k < kHarmonics; ++k) sum[bin][k] += (k == 0 ? 1 : M_SQRT2) * rest * sample.harmonics.at[k];
    weight[bin] += share;
  }
  double square = 0;
  int bins = 0;
  for (int i = 0; i < kBins; ++i) {
    if (weight[i] < 1) continue;
    for (const double part : sum[i]) square += part * part / (weight[i] * weight[i]);
    ++bins;
  }
  return std::sqrt(square / std::max(bins, 1));
}

}  // namespace microinjection
