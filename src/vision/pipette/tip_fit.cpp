#include "vision/pipette/tip_fit.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/tip_trial.h"

namespace microinjection {
namespace {

/// Rows and columns of the window of a model, beside the ends that are tried.
struct Extent {
  int before, behind, columns;
};

/// The window in which all models are compared, and the rows that an end may be off.
struct SearchWindow {
  Extent extent;
  double reach;
};

constexpr SearchWindow kUsual{{18, 20, 16}, 8}, kTight{{11, 16, 14}, 3};
constexpr double kMostSure = 2.5;              // fringes; more of them stand for something else
constexpr double kMostMove = 14;               // rows, that an end may move in all
constexpr double kOtherEnd = 0.8;              // rows, between two ends that are not the same
constexpr double kAmbiguousUndescribed = 1.5;  // the same, where neither describes the image
constexpr double kClearlyBetter = 1.115;       // what a tube in focus may leave over what one out of focus leaves
constexpr double kAmbiguous = 1.03;            // beside that, what does not tell them apart
constexpr double kBesideEdges = 9;             // rows, of a second start
constexpr double kDescribed = 0.5;             // misfit of an end that needs none
constexpr double kDescribedBeside = 0.42;      // from another start
constexpr double kNoEnd = 2;                   // misfit of what is not an end before a plain background
constexpr double kHopeless = 3;                // the same on the coarse grid, where no refinement helps
constexpr double kWitness = 1.5;               // rows
constexpr double kLocalReach = 1.5;            // rows, of the likelihood
constexpr double kModelErrorOfRange = 0.006;   // of the range of grey values, rms, in an image without noise
constexpr double kNoiseless = 0.4 / 255, kCompressedErrorOfRange = 0.03;
constexpr double kModelError = 0.1, kModelErrorOfBlur = 0.08;  // rows, of the blur: deviation without noise

struct Tube {
  const PipetteStrip& strip;
  TipOutline outline;
};

bool fits(const Tube& tube, const Extent& extent, double end, double reach) {
  return end - reach - extent.before >= 0 && end + reach + extent.behind < tube.strip.rows() &&
         extent.columns <= tube.strip.half();
}

TipWindow windowAt(const Tube& tube, const Extent& extent, double end, double reach) {
  return {tube.strip,
          static_cast<int>(end - reach - extent.before),
          static_cast<int>(end + reach + extent.behind),
          extent.columns,
          tube.outline,
          end};
}

struct Likelihood {
  double mean = 0, deviation = 0, variance = 0, range = 0;
};

/// Of the end, over all shapes beside that of a trial.
Likelihood likelihoodOf(const TipWindow& window, const TipTrial& trial, TipKind kind, double noise) {
  Likelihood result;
  result.range = window.range();
  double reach = 0.8, about = trial.end;
  for (int round = 0; round < 2; ++round) {
    const std::vector<TipTrial> all = trialsBeside(window, trial, kind, about, reach);
    result.variance = bestOf(all).rest;
    // Two pixels are folded into one. Residuals are less than the noise where the strip is smoothed.
    const double variance = std::max(result.variance, 0.5 * noise * noise);
    double weights = 0, first = 0, second = 0;
    for (const TipTrial& each : all) {
      const double weight = std::exp(-0.5 * (each.rest - result.variance) * freedomOf(window, each.model) / variance);
      weights += weight;
      first += weight * each.end;
      second += weight * each.end * each.end;
    }
    result.mean = first / weights;
    result.deviation = std::sqrt(std::max(0.0, second / weights - result.mean * result.mean));
    about = result.mean;
    reach = std::clamp(4 * result.deviation, 0.4, kLocalReach);
  }
  return result;
}

Extent extentFor(const TipModel& model, const Extent& most) {
  const int blur = static_cast<int>(std::lround(3 * model.blur * std::sqrt(1 + model.fringes)));
  return {std::min(10 + blur, most.before + 4), std::min(11 + blur, 26), model.blur < 1.75 ? 13 : 18};
}

/// Variance of the residuals of an end that the model describes.
double describedVariance(double range, double noise) {
  const double model = isCompressed(noise) ? kCompressedErrorOfRange : kModelErrorOfRange;
  return 0.5 * noise * noise + std::pow(model * range, 2);
}

constexpr TipKind kKinds[] = {TipKind::kSharp, TipKind::kFringed, TipKind::kBlurred};

TipFit fitNear(const Tube& tube, const SearchWindow& place, double coarse, double noise) {
  TipFit fit;
  TipTrial kinds[3];
  double about = coarse;
  for (int round = 0; round < 2; ++round) {
    if (!fits(tube, place.extent, about, place.reach) || std::abs(about - coarse) > kMostMove) return fit;
    const TipWindow window = windowAt(tube, place.extent, about, place.reach);
    std::vector<TipTrial> trials[3];
    TipTrial first;
    for (const TipKind kind : kKinds) {
      std::vector<TipTrial>& all = trials[static_cast<int>(kind)];
      all = coarseTrials(window, kind, about, place.reach);
      if (const TipTrial best = bestOf(all); best.rest < first.rest) first = best;
    }
    const double misfit = first.rest / describedVariance(window.range(), noise);
    if (misfit > kHopeless) {
      fit.valid = std::abs(first.end - coarse) < kMostMove;
      fit.row = first.end;
      fit.misfit = misfit;
      return fit;
    }
    double end = about, least = 1e30;
    for (const TipKind kind : kKinds) {
      TipTrial& best = kinds[static_cast<int>(kind)];
      best = refinedBest(window, kind, trials[static_cast<int>(kind)]);
      if (best.rest < least) end = best.end;
      least = std::min(least, best.rest);
    }
    if (std::abs(end - about) < 0.5 * place.reach) break;
    about = end;
  }
  const TipTrial &sharp = kinds[0], &fringed = kinds[1], &blurred = kinds[2];
  const TipKind kind_of_blur = fringed.rest < blurred.rest ? TipKind::kFringed : TipKind::kBlurred;
  const TipTrial& out = fringed.rest < blurred.rest ? fringed : blurred;
  const TipKind kind = sharp.rest < kClearlyBetter * out.rest ? TipKind::kSharp : kind_of_blur;
  const TipTrial& best = kind == TipKind::kSharp ? sharp : out;
  const double rival = sharp.rest / out.rest;
  const double apart = sharp.end - out.end;
  const Extent extent = extentFor(best.model, place.extent);
  if (!fits(tube, extent, best.end, kLocalReach)) return fit;
  const TipWindow window = windowAt(tube, extent, best.end, kLocalReach);
  const Likelihood found = likelihoodOf(window, refined(window, best, kind), kind, noise);
  fit.valid = std::abs(found.mean - coarse) < kMostMove && best.model.fringes < kMostSure;
  fit.row = found.mean;
  fit.deviation = std::hypot(found.deviation, kModelError, kModelErrorOfBlur * best.model.blur);
  fit.misfit = found.variance / describedVariance(found.range, noise);
  const double alike = fit.misfit < kDescribed && !isCompressed(noise) ? kAmbiguous : kAmbiguousUndescribed;
  // Neither describes a background that is not plain.
  fit.ambiguous = std::abs(apart) > kOtherEnd && fit.misfit < kNoEnd &&
                  std::abs(std::log(rival / kClearlyBetter)) < std::log(alike);
  return fit;
}

}  // namespace

bool isCompressed(double noise) { return noise < kNoiseless; }

TipFit fitTip(const PipetteStrip& strip, const TipOutline& outline, double coarse, double noise) {
  const Tube tube{strip, outline};
  TipFit best = fitNear(tube, kUsual, coarse, noise);
  // The edges of a tube out of focus may end far before or behind its end.
  for (const double beside : {-kBesideEdges, kBesideEdges}) {
    if (isCompressed(noise) || (best.valid && (best.misfit < kDescribed || best.misfit > kNoEnd))) break;
    const TipFit fit = fitNear(tube, kUsual, coarse + beside, noise);
    if (fit.valid && fit.misfit < (best.valid ? std::min(kDescribedBeside, best.misfit) : kDescribedBeside)) best = fit;
  }
  if (isCompressed(noise) || (best.valid && best.misfit < kDescribed)) return best;
  // What is before the end may be near it.
  const TipFit tight = fitNear(tube, kTight, coarse, noise);
  const double apart = std::abs(tight.row - coarse);
  if (tight.valid && tight.misfit < kDescribedBeside && apart < kTight.reach) return tight;
  // Before a cell no fit is good. One that finds the end of the edges again is a witness of it.
  const bool before_other = !best.valid || best.misfit > kNoEnd;
  return before_other && tight.valid && apart < kWitness ? tight : best;
}

}  // namespace microinjection
