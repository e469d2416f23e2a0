#include "vision/pipette/tip_trial.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/tip_edge.h"

namespace microinjection {
namespace {

const std::vector<double> kSharpBlurs = {1.0, 1.3, 1.6}, kBlurs = {1.3, 1.7, 2.3, 3.2, 4.6},
                          kWideBlurs = {2.0, 3.2, 4.6};
const std::vector<double> kFringes = {0.8, 1.6, 2.4}, kNoRim = {0}, kFewRims = {0, 1.2, 2.8};
constexpr double kSharpReach = 5, kFringedReach = 8;  // rows, that an end may be off
constexpr double kStepOfBlur = 0.45;                  // rows between ends that are tried
constexpr double kBlurRatio = 1.12, kRimRatio = 1.25, kFringeChange = 0.2;
constexpr double kFirstRim = 0.7, kLastRim = 6;  // rows
constexpr double kWidestBlur = 7, kNarrowestBlur = 0.8, kWidestSharpBlur = 1.8, kSharpFringes = 0.1,
                 kLeastFringes = 0.5;
constexpr int kStarts = 2;  // of each kind of model, that are refined
constexpr int kMostRounds = 8;
constexpr double kFirstStep = 0.6, kLastStep = 0.3;  // rows

/// Ends about a place, a trial for each end and rim.
void tryEnds(const TipWindow& window, const TipModel& model, const std::vector<double>& ends,
             const std::vector<double>& rims, std::vector<TipTrial>& all) {
  const EndFace face(window, ends[ends.size() / 2], model.blur);
  for (const double end : ends) {
    const std::vector<double> values = tipResiduals(window, model, end, face, rims);
    for (std::size_t k = 0; k < values.size(); ++k)
      if (rims[k] < face.widest_rim) all.push_back({end, values[k] / freedomOf(window, model), rims[k], model, true});
  }
}

std::vector<double> endsAbout(double end, double reach, double step) {
  std::vector<double> ends;
  const int count = static_cast<int>(std::lround(reach / step));
  for (int i = -count; i <= count; ++i) ends.push_back(end + i * step);
  return ends;
}

bool isOf(TipKind kind, const TipModel& model) {
  if (model.blur > kWidestBlur || model.fringes > TipEdge::kMostFringes + 1e-6) return false;
  if (kind == TipKind::kFringed) return model.fringes > kLeastFringes;
  return std::abs(model.fringes) < kSharpFringes && (model.blur < kWidestSharpBlur) == (kind == TipKind::kSharp);
}

/// Models beside that of a trial, of its kind.
std::vector<TipModel> modelsBeside(const TipModel& model, TipKind kind) {
  std::vector<TipModel> models;
  for (const double ratio : {1 / kBlurRatio, 1.0, kBlurRatio}) {
    for (const double step : {-kFringeChange, 0.0, kFringeChange}) {
      const TipModel each{std::max(kNarrowestBlur, model.blur * ratio), model.fringes + step};
      if (isOf(kind, each)) models.push_back(each);
    }
  }
  return models;
}

std::vector<double> rimsBeside(double rim, TipKind kind) {
  std::vector<double> rims = kNoRim;
  if (kind == TipKind::kBlurred) return rims;
  for (const double ratio : {1 / kRimRatio, 1.0, kRimRatio})
    if (std::max(rim, kFirstRim) * ratio < kLastRim) rims.push_back(std::max(rim, kFirstRim) * ratio);
  return rims;
}

}  // namespace

double freedomOf(const TipWindow& window, const TipModel& model) {
  return std::max(1.0, (window.rows() - termsOf(model)) * (window.columns() - 0.5));
}

TipTrial bestOf(const std::vector<TipTrial>& all) {
  return *std::min_element(all.begin(), all.end(),
                           [](const TipTrial& a, const TipTrial& b) { return a.rest < b.rest; });
}

std::vector<TipTrial> trialsBeside(const TipWindow& window, const TipTrial& trial, TipKind kind, double about,
                                   double reach) {
  std::vector<TipTrial> all;
  for (const TipModel& model : modelsBeside(trial.model, kind))
    tryEnds(window, model, endsAbout(about, reach, reach / 5), rimsBeside(trial.rim, kind), all);
  return all;
}

TipTrial refined(const TipWindow& window, TipTrial trial, TipKind kind) {
  double step = kFirstStep;
  for (int round = 0; round < kMostRounds; ++round) {
    const TipTrial before = trial;
    std::vector<TipTrial> all;
    for (const TipModel& model : modelsBeside(before.model, kind))
      tryEnds(window, model, endsAbout(before.end, step, step), rimsBeside(before.rim, kind), all);
    trial = bestOf(all);
    const bool settled = trial.model.blur == before.model.blur && trial.model.fringes == before.model.fringes &&
                         std::abs(trial.end - before.end) < 0.5 * step;
    if (settled && step < kLastStep) break;
    if (settled) step *= 0.5;
  }
  return trial;
}

std::vector<TipTrial> coarseTrials(const TipWindow& window, TipKind kind, double about, double most) {
  std::vector<TipTrial> all;
  const auto add = [&](const TipModel& model, double reach, const std::vector<double>& rims) {
    tryEnds(window, model, endsAbout(about, std::min(reach, most), kStepOfBlur * model.blur), rims, all);
  };
  if (kind == TipKind::kSharp)
    for (const double blur : kSharpBlurs) add({blur, 0}, kSharpReach, kFewRims);
  if (kind == TipKind::kBlurred)
    for (const double blur : kWideBlurs) add({blur, 0}, kFringedReach, kNoRim);
  if (kind == TipKind::kFringed)
    for (const double blur : kBlurs)
      for (const double fringes : kFringes) add({blur, fringes}, kFringedReach, kFewRims);
  return all;
}

TipTrial refinedBest(const TipWindow& window, TipKind kind, const std::vector<TipTrial>& all) {
  TipTrial best;
  std::vector<double> ends;
  for (int start = 0; start < kStarts; ++start) {
    TipTrial next;
    for (const TipTrial& trial : all) {
      const bool near = std::any_of(ends.begin(), ends.end(), [&](double end) {
        return std::abs(trial.end - end) < std::max(1.5, 0.8 * trial.model.blur);
      });
      if (!near && trial.rest < next.rest) next = trial;
    }
    if (!next.valid) break;
    ends.push_back(next.end);
    const TipTrial found = refined(window, next, kind);
    if (found.rest < best.rest) best = found;
  }
  return best;
}

}  // namespace microinjection
