#include "vision/layers/layer_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <vector>

#include "vision/layers/layer_solver.h"

namespace microinjection {
namespace {

constexpr int kSectors = 72, kCoarseEvery = 3, kTrackedSectors = 36;
constexpr double kSamplesInside = 13, kSamplesOutside = 10;  // px, of the samples, beyond ooplasm and zona
constexpr double kThinnestZona = 4;                          // px
constexpr int kCoarseSteps = 6, kTrialSteps = 5, kFineSteps = 4, kTrackedSteps = 3;
constexpr double kOtherPlaces[] = {-8, -5, 5};  // px, of the ooplasm, when the first one is not described
constexpr std::size_t kTrials = 3;              // places of the inner border that are refined
constexpr double kSameBorder = 1;               // px
constexpr double kPoorFit = 0.06;               // misfit over the line's contrast: the first borders may be others

using Vector = Eigen::VectorXd;

/// The ellipse whose border is `place(harmonics)` px from the base.
template <typename Place>
Ellipse ellipseAlong(const Ellipse& base, const Place& place) {
  std::vector<cv::Point2d> points;
  for (int i = 0; i < kSectors; ++i) {
    const double angle = 2 * M_PI * i / kSectors, radius = base.radius(angle) + place(angle);
    points.push_back(base.centre + radius * cv::Point2d(std::cos(angle), std::sin(angle)));
  }
  const EllipseFit fit = fitEllipse(points, base, 1.0);
  return fit.valid ? fit.ellipse : base;
}

/// A cosine's amplitude moves the centre by itself. `minus`: parameters that are subtracted, or -1.
Eigen::Matrix3d covarianceOf(const Eigen::MatrixXd& all, int first, int minus = -1) {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(3, all.rows());
  const auto add = [&](int index, double sign) {
    slope(0, index + 1) += sign;
    slope(1, index + 2) += sign;
    slope(2, index) += 2 * sign;
  };
  add(first, 1);
  if (minus >= 0) add(minus, -1);
  return slope * all * slope.transpose();
}

struct Trial {
  Vector parameters;
  double chi2 = 1e300;
};

/// The best place of the inner border: those that explain most are refined. `second`: chi^2 of the next.
Trial searchInner(LayerSolver& solver, const LayerModel& model, const Vector& start, double thickest, double& second) {
  const int count = std::max(1, static_cast<int>(thickest - kThinnestZona) + 1);
  const std::vector<double> gains = solver.scan(model, start, kThinnestZona, count);
  std::vector<std::pair<double, double>> peaks;
  for (int i = 0; i < count; ++i) {
    const bool peak = (i == 0 || gains[i] >= gains[i - 1]) && (i + 1 == count || gains[i] >= gains[i + 1]);
    if (peak) peaks.emplace_back(gains[i], kThinnestZona + i);
  }
  std::sort(peaks.rbegin(), peaks.rend());
  Trial best;
  second = 1e300;
  for (std::size_t i = 0; i < peaks.size() && i < kTrials; ++i) {
    Vector trial = start;
    trial[LayerModel::kThickness] = peaks[i].second;
    solver.solveAmplitudes(model, trial);
    solver.iterate(model, trial, kTrialSteps, false);
    const double chi2 = solver.chi2(model, trial);
    const bool same = best.parameters.size() > 0 &&
                      std::abs(trial[LayerModel::kThickness] - best.parameters[LayerModel::kThickness]) < kSameBorder;
    if (!same) second = std::min(second, std::max(chi2, best.chi2));
    if (chi2 < best.chi2) {
      if (!same && best.chi2 < 1e299) second = best.chi2;
      best = {trial, chi2};
    }
  }
  return best;
}

/// What the model without the inner border makes of an ooplasm that is `shift` px from its first ellipse.
Vector coarseFit(LayerSolver& solver, const LayerModel& model, double shift) {
  Vector parameters = solver.start(model, 0, shift);
  solver.iterate(model, parameters, kCoarseSteps, true);
  return parameters;
}

bool isPoor(const LayerSolver& solver, const LayerModel& model, const Vector& p) {
  return p[LayerModel::kOuterLineDepth] > 0 || p[LayerModel::kRimDepth] > 0 ||
         solver.misfit(model, p, 0) > kPoorFit * model.contrast(p, 0) ||
         solver.misfit(model, p, 2) > kPoorFit * model.contrast(p, 2);
}

/// The places of all borders by every third sector.
bool searchBorders(const LayerSamples& samples, const LayerGuess& guess, ContrastMode mode, const LayerModel& with,
                   Vector& parameters, LayerFit& result) {
  const LayerModel without(mode, false);
  LayerSolver coarse(samples, guess.ooplasm, guess.rim, kCoarseEvery);
  Vector start = coarseFit(coarse, without, 0);
  double cost = coarse.cost();
  if (isPoor(coarse, without, start)) {
    for (const double shift : kOtherPlaces) {
      const Vector other = coarseFit(coarse, without, shift);
      if (coarse.cost() >= cost) continue;
      cost = coarse.cost();
      start = other;
    }
    coarse.weigh(without, start);
  }
  const double chi_without = coarse.chi2(without, start);
  Vector first = Vector::Zero(with.size());
  first.head(LayerModel::kShapes) = start.head(LayerModel::kShapes);
  const double thickest = 0.5 * (guess.outer.meanDiameter() - guess.ooplasm.meanDiameter()) +
                          start[LayerModel::kOuter] - start[LayerModel::kOoplasm] + 1;
  double second = 1e300;
  const Trial best = searchInner(coarse, with, first, thickest, second);
  if (best.parameters.size() == 0) return false;
  parameters = best.parameters;
  const double gain = std::max(chi_without - best.chi2, 1e-9);
  result.inner_gain = kCoarseEvery * gain / coarse.correlated();
  result.rival = second < 1e299 ? std::max(0.0, (chi_without - second) / gain) : 0;
  return true;
}

void describe(LayerSolver& solver, const LayerModel& model, const Vector& p, const LayerGuess& guess,
              LayerFit& result) {
  const Eigen::MatrixXd covariance = solver.covariance(model, p);
  const auto outerAt = [&](const LayerModel::Harmonics& h) { return h.sum(p, LayerModel::kOuter, 5); };
  result.outer.ellipse = ellipseAlong(guess.outer, [&](double a) { return outerAt(LayerModel::Harmonics(a)); });
  result.inner.ellipse = ellipseAlong(guess.outer, [&](double a) {
    const LayerModel::Harmonics h(a);
    return outerAt(h) - h.sum(p, LayerModel::kThickness, 3);
  });
  result.ooplasm.ellipse = ellipseAlong(guess.outer, [&](double a) {
    return guess.ooplasm.reach(guess.outer.centre, a) - guess.outer.radius(a) +
           LayerModel::Harmonics(a).sum(p, LayerModel::kOoplasm, 5);
  });
  result.outer.covariance = covarianceOf(covariance, LayerModel::kOuter);
  result.inner.covariance = covarianceOf(covariance, LayerModel::kOuter, LayerModel::kThickness);
  result.ooplasm.covariance = covarianceOf(covariance, LayerModel::kOoplasm);
  result.outer.line = p[LayerModel::kOuterLineDepth];
  result.inner.line = p[LayerModel::kInnerLineDepth];
  result.ooplasm.line = p[LayerModel::kRimDepth];
  result.outer.width = 2 * p[LayerModel::kOuterLine];
  result.inner.width = 2 * p[LayerModel::kInnerLine];
  result.ooplasm.width = p[LayerModel::kRim];
  result.outer.misfit = solver.misfit(model, p, 0) / std::max(model.contrast(p, 0), 1e-6);
  result.ooplasm.misfit = solver.misfit(model, p, 2) / std::max(model.contrast(p, 2), 1e-6);
  result.used = solver.used();
  result.blur = p[LayerModel::kBlur];
  result.valid = true;
}

}  // namespace

LayerFit fitLayers(const Frame& frame, const LayerGuess& guess, ContrastMode mode) {
  LayerFit result;
  double low = 0;
  for (int i = 0; i < kSectors; ++i) {
    const double angle = 2 * M_PI * i / kSectors;
    low = std::min(low, guess.ooplasm.reach(guess.outer.centre, angle) - guess.outer.radius(angle));
  }
  const bool known = guess.thickness > 0;
  const LayerSamples samples(frame, guess.outer, low - kSamplesInside, kSamplesOutside,
                             known ? kTrackedSectors : kSectors);
  const LayerModel with(mode, true);
  Vector parameters;
  if (known) {
    Vector near = Vector::Zero(with.size());
    near[LayerModel::kThickness] = guess.thickness;
    near[LayerModel::kRim] = guess.rim;
    LayerSolver solver(samples, guess.ooplasm, guess.rim, 1, near);
    parameters = solver.start(with, guess.thickness, 0);
    solver.iterate(with, parameters, kTrackedSteps, true);
    describe(solver, with, parameters, guess, result);
    return result;
  }
  if (!searchBorders(samples, guess, mode, with, parameters, result)) return result;
  LayerSolver solver(samples, guess.ooplasm, guess.rim, 1, parameters);
  solver.iterate(with, parameters, kFineSteps, true);
  describe(solver, with, parameters, guess, result);
  return result;
}

}  // namespace microinjection
