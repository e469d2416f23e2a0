#include "vision/detection/pipette_detector.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/holding_pipette.h"
#include "vision/detection/injection_pipette.h"

namespace microinjection {
namespace {

constexpr int kAxes = 5, kHoldingAxes = 8;
constexpr double kWider = 1.38;                    // ratio of two outlines' widths that tells them apart
constexpr double kTipReach = 10, kMouthReach = 8;  // px beside the reach of tracking
constexpr int kRoundsOfTracking = 2;
constexpr int kFinest = 1, kFinestBesideBorder = 2;  // see AxisSearch::finer
constexpr double kBesideBorder = 120;                // px

}  // namespace

PipetteDetectorConfig PipetteDetectorConfig::read(ConfigReader& reader) {
  PipetteDetectorConfig config;
  reader.choice("kind", config.kind, {"injection", "holding"});
  reader.number("direction", config.direction, Range::closed(-2 * M_PI, 2 * M_PI));
  reader.number("tolerance", config.tolerance, Range::closed(0.02, M_PI / 2));
  reader.number("widest", config.widest, Range::closed(4, 1e4));
  reader.vector("region", config.region, Range::closed(0, 1e5));
  return config;
}

PipetteDetector::PipetteDetector(const PipetteDetectorConfig& config) : config_(config) {}

PipetteDetection PipetteDetector::detect(const Frame& frame) const {
  PipetteDetection best;
  if (!frame.refusal().empty()) {
    best.finding = Finding::notFound(frame.refusal());
    return best;
  }
  AxisSearch search;
  search.direction = config_.direction;
  search.tolerance = config_.tolerance;
  search.widest = config_.widest;
  if (config_.region[2] > 0) {
    search.region = cv::Rect(static_cast<int>(config_.region[0]), static_cast<int>(config_.region[1]),
                             static_cast<int>(config_.region[2]), static_cast<int>(config_.region[3]));
  }
  best.finding = Finding::notFound("no pipette: no two straight edges from the side that it comes from");
  const bool whole = search.region.empty();
  const int finest = config_.kind == "injection" && whole ? kFinestBesideBorder : kFinest;
  // A finer search costs four times as much: only for pipettes of which too little is seen. The finest
  // one is for a needle that has just come into the frame.
  for (; search.finer <= finest && !best.finding.hasValues(); ++search.finer) {
    if (search.finer == kFinestBesideBorder) search.from_border = kBesideBorder;
    for (const PipetteAxis& axis : findPipetteAxes(frame, search, config_.kind == "holding" ? kHoldingAxes : kAxes)) {
      if (best.finding.isFound() && axis.outlineAt(best.end) < kWider * best.half_width) continue;
      take(best, measure(frame, axis));
      if (best.finding.isFound() && config_.kind == "injection") return best;
    }
  }
  return best;
}

/// A thick wall is symmetric to an axis of its own: the widest outline is that of the whole holding
/// pipette. Of injection pipettes that are not certain the most symmetric one is taken.
void PipetteDetector::take(PipetteDetection& best, const PipetteDetection& found) const {
  if (!found.finding.hasValues()) {
    if (!best.finding.hasValues()) best.finding = found.finding;
    return;
  }
  const bool holding = config_.kind == "holding";
  const bool better = holding ? found.half_width > kWider * best.half_width : found.symmetry > best.symmetry;
  const bool surer = found.finding.isFound() && !best.finding.isFound();
  const bool less_sure = !found.finding.isFound() && best.finding.isFound();
  if (!best.finding.hasValues() || surer || (better && !less_sure)) best = found;
}

PipetteDetection PipetteDetector::track(const Frame& frame, const PipetteDetection& previous, double reach) const {
  PipetteDetection found;
  found.finding = Finding::notFound("there is no earlier pipette to follow");
  if (!frame.refusal().empty()) found.finding = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty() || !previous.finding.hasValues()) return found;
  PipetteAxis axis;
  axis.point = previous.end;
  axis.direction = previous.direction;
  axis.half_width = previous.half_width;
  axis.taper = previous.taper;
  if (config_.kind == "injection") {
    return refineInjection(frame, axis, previous.end, reach + kTipReach, config_.widest, kRoundsOfTracking);
  }
  return refineHolding(frame, axis, previous.end, reach + kMouthReach, 1);
}

PipetteDetection PipetteDetector::measure(const Frame& frame, const PipetteAxis& axis) const {
  return config_.kind == "holding" ? measureHolding(frame, axis, config_.widest)
                                   : measureInjection(frame, axis, config_.widest);
}

}  // namespace microinjection
