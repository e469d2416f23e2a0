#include "vision/track/frame_search.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace microinjection {
namespace {

constexpr double kShaftWidths = 4, kShortestShaft = 60;  // half widths; px: of a shaft that must be glass
constexpr double kLeastGlass = 0.3;                      // probability, mean along the shaft

/// Whether a place is within the outline of a pipette.
bool isOn(const ProposedPipette& pipette, const cv::Point2d& place) {
  const cv::Point2d shaft = pipette.entry - pipette.end, away = place - pipette.end;
  const double length = cv::norm(shaft), along = away.dot(shaft) / length,
               across = std::abs(away.cross(shaft)) / length;
  return along > -pipette.tolerance && along < length && across < pipette.half_width + pipette.tolerance;
}

}  // namespace

const Proposal& FrameSearch::proposal() {
  if (!proposal_) proposal_ = eye_->propose(frame_);
  return *proposal_;
}

CellDetection FrameSearch::cell(const CellDetector& detector) {
  return detector.detect(frame_, eye_ == nullptr ? nullptr : &proposal());
}

PipetteDetection FrameSearch::pipette(const PipetteDetector& detector) {
  if (eye_ == nullptr) return detector.detect(frame_);
  const std::string& kind = detector.config().kind;
  const bool needle = kind == "injection", told = !detector.config().any_direction;
  std::optional<ProposedPipette> seen = needle ? proposal().injection : proposal().holding;
  PipetteDetection found;
  found.finding = Finding::notFound("a network sees no such pipette");
  if (seen) {
    seen = eye_->lookCloser(frame_, kind, *seen);
    found = detector.detect(frame_, *seen);
    if (found.second && found.second->isFound()) return found;
  }
  if (!told && !proposal().glass.anywhere) return found;
  PipetteDetection other = detector.detect(frame_);
  if (!other.finding.hasValues()) return found;
  const std::optional<ProposedPipette>& other_kind = needle ? proposal().holding : proposal().injection;
  if (seen && detector.isAllowed(*seen) && !detector.isAtEnd(other, *seen))
    other.hear(Finding::uncertain(PipetteDetector::kSeenElsewhere));
  // Which kind comes from there is told: then the network has taken one for the other.
  else if (other_kind && isOn(*other_kind, other.end) && !(told && detector.isAllowed(*other_kind)))
    other.hear(Finding::uncertain("a network sees a pipette of the other kind there"));
  else if (!told && !isGlass(other))
    other.hear(Finding::uncertain("a network sees no glass there"));
  return other.finding.isFound() || !found.finding.hasValues() ? other : found;
}

bool FrameSearch::isGlass(const PipetteDetection& pipette) {
  const double shaft = std::max(kShaftWidths * pipette.half_width, kShortestShaft);
  return proposal().glass.along(pipette.end, pipette.direction, shaft) >= kLeastGlass;
}

}  // namespace microinjection
