#include "vision/pipette/pipette_detector.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/holding_pipette.h"
#include "vision/pipette/injection_pipette.h"

namespace microinjection {
namespace {

constexpr int kAxes = 5, kHoldingAxes = 8;
constexpr double kWider = 1.38;                    // ratio of two outlines' widths that tells them apart
constexpr double kTipReach = 10, kMouthReach = 8;  // px beside the reach of tracking
constexpr int kRoundsAtProposal = 3;
constexpr double kProposedTolerance = 0.3;           // rad, of a direction that a second eye sees
constexpr double kProposedMargin = 2;                // of the half width, of the region that is searched
constexpr int kFinest = 1, kFinestBesideBorder = 2;  // see AxisSearch::finer
constexpr double kBesideBorder = 120;                // px
// Of the half width, of a mouth: a second eye sees it along the axis better than beside it.
constexpr double kMouthAlong = 0.27, kSameMouthAlong = 0.12, kSameMouthBeside = 0.5;
constexpr double kSamePipetteDirection = 0.6;  // rad, of a wide shaft that the frame cuts a second eye sees it slanted
constexpr double kFaded = 3;                   // tolerances along the shaft, in which a second eye overlooks a thin tip
constexpr double kSameClearness = 0.9;         // of the clearness, of an end that is told by a second eye

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
  PipetteDetection none;
  none.finding = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty()) return none;
  AxisSearch search;
  search.direction = config_.direction;
  search.tolerance = config_.tolerance;
  search.widest = config_.widest;
  search.region = region();
  const bool whole = search.region.empty();
  return this->search(frame, search, config_.kind == "injection" && whole ? kFinestBesideBorder : kFinest);
}

cv::Rect PipetteDetector::region() const {
  if (!(config_.region[2] > 0)) return {};
  return {static_cast<int>(config_.region[0]), static_cast<int>(config_.region[1]), static_cast<int>(config_.region[2]),
          static_cast<int>(config_.region[3])};
}

PipetteDetection PipetteDetector::search(const Frame& frame, AxisSearch search, int finest) const {
  PipetteDetection best;
  best.finding = Finding::notFound("no pipette: no two straight edges from the side that it comes from");
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

PipetteDetection PipetteDetector::detect(const Frame& frame, const ProposedPipette& proposed) const {
  PipetteDetection found;
  found.finding = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty()) return found;
  found.finding = Finding::notFound("the pipette comes from another side, or is not in the region that is told");
  if (!isAllowed(proposed)) return found;
  const double direction = proposed.direction(), tolerance = proposed.tolerance;
  found = search(frame, searchAt(frame, proposed), kFinest);
  const bool elsewhere = !found.finding.hasValues() || cv::norm(found.end - proposed.end) > tolerance;
  if (elsewhere || !found.finding.isFound()) {
    const PipetteDetection refined =
        refine(frame, {proposed.end, direction, proposed.half_width, 0, 0}, proposed.end, tolerance, kRoundsAtProposal);
    const bool better = elsewhere
                            ? refined.finding.hasValues()
                            : refined.finding.isFound() && (isAtEnd(refined, proposed) || !isAtEnd(found, proposed));
    if (better) found = refined;
  }
  if (!found.finding.hasValues()) {
    found.finding = Finding::notFound("a network sees a pipette whose end cannot be measured");
    return found;
  }
  found.hear(isAtEnd(found, proposed) ? Finding::found() : Finding::uncertain(kSeenElsewhere));
  if (found.second->isFound() && isSameMouth(found, proposed)) found.confirm();
  return found;
}

bool PipetteDetector::isAllowed(const ProposedPipette& proposed) const {
  const cv::Rect2d told(region());
  return (told.empty() || told.contains(proposed.end)) &&
         (config_.any_direction || angleBetween(proposed.direction(), config_.direction) <= config_.tolerance);
}

bool PipetteDetector::isAtEnd(const PipetteDetection& pipette, const ProposedPipette& proposed) const {
  const cv::Point2d seen = pipette.inAxes(proposed.end);
  if (angleBetween(pipette.direction, proposed.direction()) > kSamePipetteDirection) return false;
  if (config_.kind == "holding")
    return std::abs(seen.x) <= kMouthAlong * pipette.half_width && std::abs(seen.y) <= pipette.half_width;
  return seen.x >= -proposed.tolerance && seen.x <= kFaded * proposed.tolerance &&
         std::abs(seen.y) <= proposed.tolerance;
}

bool PipetteDetector::isSameEdge(const PipetteDetection& before, const PipetteDetection& now) {
  return now.clearness >= kSameClearness * *before.confirmed &&
         std::abs(before.inAxes(now.end).x) <= kSameMouthAlong * before.half_width &&
         std::abs(now.half_width / before.half_width - 1) < kSameMouthAlong;
}

bool PipetteDetector::isSameMouth(const PipetteDetection& pipette, const ProposedPipette& proposed) const {
  const cv::Point2d away = pipette.inAxes(proposed.end);
  return config_.kind == "holding" && std::abs(away.x) <= kSameMouthAlong * pipette.half_width &&
         std::abs(away.y) <= kSameMouthBeside * pipette.half_width;
}

AxisSearch PipetteDetector::searchAt(const Frame& frame, const ProposedPipette& proposed) const {
  AxisSearch search;
  search.direction = proposed.direction();
  search.tolerance = kProposedTolerance;
  search.widest = config_.widest;
  const cv::Rect whole({0, 0}, frame.grey().size()), told = region();
  const cv::Rect allowed = told.empty() ? whole : whole & told;
  const double margin = kProposedMargin * proposed.half_width + proposed.tolerance;
  const cv::Rect2d way(
      cv::Point2d(std::min(proposed.end.x, proposed.entry.x), std::min(proposed.end.y, proposed.entry.y)),
      cv::Point2d(std::max(proposed.end.x, proposed.entry.x), std::max(proposed.end.y, proposed.entry.y)));
  search.region =
      cv::Rect(cv::Point(way.tl() - cv::Point2d(margin, margin)), cv::Point(way.br() + cv::Point2d(margin, margin))) &
      allowed;
  return search;
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
  const bool injection = config_.kind == "injection";
  found = refine(frame, axis, previous.end, reach + (injection ? kTipReach : kMouthReach), injection ? 2 : 1);
  if (previous.second) found.hear(*previous.second);
  if (previous.confirmed && isSameEdge(previous, found)) {
    found.confirmed = previous.confirmed;
    found.confirm();
  }
  return found;
}

PipetteDetection PipetteDetector::refine(const Frame& frame, const PipetteAxis& axis, const cv::Point2d& end,
                                         double reach, int rounds) const {
  return config_.kind == "injection" ? refineInjection(frame, axis, end, reach, config_.widest, rounds)
                                     : refineHolding(frame, axis, end, reach, rounds);
}

PipetteDetection PipetteDetector::measure(const Frame& frame, const PipetteAxis& axis) const {
  return config_.kind == "holding" ? measureHolding(frame, axis, config_.widest)
                                   : measureInjection(frame, axis, config_.widest);
}

}  // namespace microinjection
