#include "vision/calibration/calibrate.h"

#include <algorithm>
#include <set>

#include "base/config_errors.h"
#include "vision/calibration/calibration_fit.h"

namespace microinjection {
namespace {

constexpr int kRounds = 10;  ///< of fit and flags, until the flags stay

/// Returns whether a fit was found.
bool fitAndFlag(CalibrationFit& problem) {
  if (!problem.solve(true)) return false;
  problem.flagOutliers();
  for (int i = 0; i < kRounds; ++i) {
    if (problem.freedom() < 1 || !problem.solve(false)) return false;
    if (!problem.flagOutliers()) break;
  }
  // A reweighted fit moves the parameters that tips and focus readings share.
  for (int i = 0; i < 2; ++i) {
    problem.scaleByResiduals();
    if (!problem.solve(false)) return false;
  }
  problem.scaleByResiduals();
  return true;
}

std::vector<int> outliersOf(const CalibrationData& data, const CalibrationFit& problem) {
  std::set<int> outliers;
  for (std::size_t k = 0; k < data.pixels.size(); ++k) {
    if (!problem.usedPixels()[k]) outliers.insert(data.pixels[k]);
  }
  for (std::size_t k = 0; k < data.focus.size(); ++k) {
    if (!problem.usedFocus()[k]) outliers.insert(data.focus[k]);
  }
  return {outliers.begin(), outliers.end()};
}

void checkCounts(const CalibrationData& data, const CalibrationFit& problem, const CalibrationLimits& limits,
                 ConfigErrors& errors) {
  const auto& used = problem.usedPixels();
  const auto good = static_cast<int>(std::count(used.begin(), used.end(), true));
  const double share = 1 - static_cast<double>(good) / static_cast<double>(used.size());
  errors.require(Range::closed(0, limits.largest_outlier_share), "share of outliers", share);
  errors.require(good >= limits.least_points, "points without outliers", good, "",
                 "at least " + std::to_string(limits.least_points));
  if (data.focus.empty()) return;
  const auto& focus = problem.usedFocus();
  const auto readings = static_cast<int>(std::count(focus.begin(), focus.end(), true));
  errors.require(readings >= limits.least_focus_points && problem.focusFreedom() >= 1,
                 "focus readings without outliers", readings, "",
                 "at least " + std::to_string(limits.least_focus_points));
}

CameraCalibration resultOf(const CalibrationData& data, const CalibrationStart& start, const CalibrationFit& problem,
                           const CalibrationSetup& setup) {
  CameraCalibration result;
  result.date = setup.date;
  result.mirrored = start.mirrored;
  result.origin = data.origin;
  result.reference_pixel = setup.reference_pixel;
  result.image_size = setup.image_size;
  result.value = problem.value();
  result.estimated = data.estimated;
  result.freedom = std::max(1, problem.freedom());
  result.focus_freedom = std::max(1, problem.focusFreedom());
  result.variance_factor = problem.varianceFactor();
  result.residual = problem.residual();
  result.focus_residual = data.focus.empty() ? 0 : problem.focusResidual();
  const auto& used = problem.usedPixels();
  const auto& focus = problem.usedFocus();
  result.points = static_cast<int>(std::count(used.begin(), used.end(), true));
  result.focus_points = static_cast<int>(std::count(focus.begin(), focus.end(), true));
  result.tips = setup.tips;
  return result;
}

}  // namespace

CalibrationOutcome calibrate(const std::vector<TipObservation>& waypoints, const CalibrationLimits& limits,
                             const CalibrationSetup& setup) {
  CalibrationOutcome outcome;
  if (!isDate(setup.date)) outcome.refusals.push_back("date = " + setup.date + ": must be YYYY-MM-DDTHH:MM:SSZ");
  if (!setup.reference_pixel.allFinite()) outcome.refusals.emplace_back("reference_pixel: must be finite");
  const CalibrationData data = prepareData(waypoints, limits, outcome.refusals);
  if (!outcome.refusals.empty()) return outcome;
  const auto refuse = [&](const std::string& reason) {
    outcome.refusals.push_back(reason);
    return outcome;
  };
  const std::optional<CalibrationStart> start = linearStart(data);
  if (!start) return refuse("the observations do not determine the axes: the pixel does not follow every axis");
  CalibrationFit problem(data, *start);
  if (!fitAndFlag(problem)) return refuse("the fit did not converge: pixels and positions do not belong together");
  outcome.outliers = outliersOf(data, problem);
  ConfigErrors errors;
  checkCounts(data, problem, limits, errors);
  outcome.refusals = errors.messages();
  if (!errors.good()) return outcome;
  CameraCalibration result = resultOf(data, *start, problem, setup);
  result.outliers = static_cast<int>(outcome.outliers.size());
  if (!problem.covariance(result.covariance)) errors.add("the observations do not determine every parameter");
  for (const std::string& refusal : refusalsOf(result, limits)) errors.add(refusal);
  outcome.refusals = errors.messages();
  if (!errors.good()) return outcome;
  const TipRecord tip = result.tipRecord(setup.date);
  outcome.warning = tipWarning(tip, result.tips);
  result.tips.push_back(tip);
  outcome.calibration = result;
  return outcome;
}

}  // namespace microinjection
