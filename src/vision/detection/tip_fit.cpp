#include "vision/detection/tip_fit.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/tip_model.h"

namespace microinjection {
namespace {

/// Rows and columns of the window of a model, beside the ends that are tried.
struct Extent {
  int before, behind, columns;
};

constexpr Extent kSharp{14, 17, 13}, kNear{14, 14, 13}, kBlurred{18, 26, 18};
constexpr Extent kCommon{18, 20, 18};  // in which both models are compared
const std::vector<double> kSharpBlurs = {1.0, 1.25, 1.6}, kBlurredBlurs = {1.8, 2.5, 3.4, 4.6, 6.2};
const std::vector<double> kRims = {0, 0.7, 1.4, 2.2, 3.2, 4.5}, kNoRim = {0}, kFewRims = {0, 1.2, 2.8};
constexpr double kReach = 4;  // rows, that an end may be off
constexpr int kMostRounds = 8;
constexpr double kBesideEdges = 7;            // rows, of a second start out of focus
constexpr double kFarthest = 8;               // rows, that an end may move in all
constexpr double kModelErrorOfRange = 0.006;  // of the range of grey values, rms, in an image without noise
constexpr double kClearlyBetter = 1.4;        // residuals in focus over those out of focus, of a tube out of focus
constexpr double kModelError = 0.1, kModelErrorOfBlur = 0.08;  // rows, of the blur: deviation without noise

/// Likelihood of the end, over all blurs and rims that were tried.
struct Likelihood {
  double mean = 0, deviation = 0, lowest = 1e30, blur = 0, rim = 0, freedom = 1, range = 0;
  double variance() const { return lowest / freedom; }  ///< of the residuals
};

struct Search {
  TipModel model;
  double reach;
  std::vector<double> blurs, rims;
  int ends;  ///< that are tried on each side
};

bool fits(const PipetteStrip& strip, const Extent& extent, double end, double reach) {
  return end - reach - extent.before >= 0 && end + reach + extent.behind < strip.rows() &&
         extent.columns <= strip.half();
}

TipWindow windowAt(const PipetteStrip& strip, const Extent& extent, double end, double reach) {
  return {strip, static_cast<int>(end - reach - extent.before), static_cast<int>(end + reach + extent.behind),
          extent.columns};
}

Likelihood likelihoodOf(const TipWindow& window, const Search& search, double about, double noise) {
  Likelihood result;
  std::vector<double> ends, squares;
  for (const double blur : search.blurs) {
    const std::vector<double> face = endFace(window, about, blur);
    for (int i = -search.ends; i <= search.ends; ++i) {
      const double end = about + search.reach * i / search.ends;
      const std::vector<double> values = tipResiduals(window, search.model, end, blur, face, search.rims);
      for (std::size_t k = 0; k < values.size(); ++k) {
        ends.push_back(end);
        squares.push_back(values[k]);
        if (values[k] >= result.lowest) continue;
        result.lowest = values[k];
        result.blur = blur;
        result.rim = search.rims[k];
      }
    }
  }
  result.range = window.range();
  result.freedom = std::max(1.0, (window.rows() - search.model.terms()) * (window.columns() - 0.5));
  // Two pixels are folded into one. Residuals are less than the noise where the strip is smoothed.
  const double variance = std::max(result.variance(), 0.5 * noise * noise);
  double weights = 0, first = 0, second = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double weight = std::exp(-0.5 * (squares[i] - result.lowest) / variance);
    weights += weight;
    first += weight * ends[i];
    second += weight * ends[i] * ends[i];
  }
  result.mean = first / weights;
  result.deviation = std::sqrt(std::max(0.0, second / weights - result.mean * result.mean));
  return result;
}

std::vector<double> around(double value, double ratio, int steps) {
  std::vector<double> values;
  for (int i = -steps; i <= steps; ++i) values.push_back(value * std::pow(ratio, i));
  return values;
}

/// The most likely end near a place; NaN when it moves away.
Likelihood search(const PipetteStrip& strip, const Extent& extent, double coarse, double noise, bool blurred) {
  Search search{{blurred}, kReach, blurred ? kBlurredBlurs : kSharpBlurs, blurred ? kNoRim : kRims, 8};
  Likelihood found;
  found.mean = coarse;
  int settled = 0;
  for (int round = 0; round < kMostRounds && settled < 3; ++round) {
    const double before = found.mean;
    if (!fits(strip, extent, before, search.reach) || std::abs(before - coarse) > kFarthest) {
      settled = 0;
      break;
    }
    found = likelihoodOf(windowAt(strip, extent, before, search.reach), search, before, noise);
    if (std::abs(found.mean - before) > 0.7 * search.reach) continue;
    ++settled;
    search.ends = 10;
    search.reach = std::clamp(4 * found.deviation, 1.0, kReach);
    search.blurs = around(found.blur, 1.13, 1);
    if (found.rim > 0) {
      search.rims = around(found.rim, 1.19, 2);
      search.rims.push_back(0);
    }
  }
  if (settled == 0 || std::abs(found.mean - coarse) > kFarthest) found.mean = std::nan("");
  return found;
}

TipFit fitOf(const Likelihood& found, double noise) {
  TipFit fit;
  fit.valid = std::isfinite(found.mean);
  fit.row = found.mean;
  fit.deviation = std::hypot(found.deviation, kModelError, kModelErrorOfBlur * found.blur);
  fit.misfit = found.variance() / (0.5 * noise * noise + std::pow(kModelErrorOfRange * found.range, 2));
  return fit;
}

/// Whether the model of a tube out of focus leaves much less in the same window.
bool blurredIsBetter(const PipetteStrip& strip, double end, double noise) {
  if (!fits(strip, kCommon, end, kReach)) return false;
  const TipWindow window = windowAt(strip, kCommon, end, kReach);
  double rest[2];
  for (const bool blurred : {false, true}) {
    const Search each{{blurred}, kReach, blurred ? kBlurredBlurs : kSharpBlurs, blurred ? kNoRim : kFewRims, 6};
    const Likelihood found = likelihoodOf(window, each, end, noise);
    rest[blurred] = found.variance();
  }
  return rest[0] > kClearlyBetter * rest[1];
}

}  // namespace

TipFit fitTip(const PipetteStrip& strip, double coarse, double noise) {
  const Likelihood sharp = search(strip, kSharp, coarse, noise, false);
  if (std::isfinite(sharp.mean)) {
    for (const double row : {coarse, sharp.mean}) {
      if (blurredIsBetter(strip, row, noise)) continue;
      // A polynomial fits fewer rows better, but more of them find the end from farther away.
      const Likelihood near = search(strip, kNear, sharp.mean, noise, false);
      return fitOf(std::isfinite(near.mean) ? near : sharp, noise);
    }
  }
  // The edges of a tube out of focus may end before or behind its end.
  Likelihood best;
  best.mean = std::nan("");
  for (const double start : {coarse, coarse - kBesideEdges}) {
    const Likelihood found = search(strip, kBlurred, start, noise, true);
    if (std::isfinite(found.mean) && (!std::isfinite(best.mean) || found.variance() < best.variance())) best = found;
  }
  return fitOf(best, noise);
}

}  // namespace microinjection
