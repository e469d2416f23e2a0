#include "vision/detection/frame_search.h"

#include <algorithm>
#include <string>

namespace microinjection {
namespace {

constexpr double kShaftWidths = 4, kShortestShaft = 60;  // half widths; px: of a shaft that must be glass
constexpr double kLeastGlass = 0.3;                      // probability, mean along the shaft

}  // namespace

const Proposal& FrameSearch::proposal() {
  if (!proposal_) proposal_ = eye_->look(frame_);
  return *proposal_;
}

CellDetection FrameSearch::cell(const CellDetector& detector) {
  return eye_ == nullptr ? detector.detect(frame_) : detector.detect(frame_, proposal());
}

PipetteDetection FrameSearch::pipette(const PipetteDetector& detector) {
  if (eye_ == nullptr) return detector.detect(frame_);
  const std::string& kind = detector.config().kind;
  const std::optional<ProposedPipette>& proposed = kind == "injection" ? proposal().injection : proposal().holding;
  PipetteDetection found;
  found.finding = Finding::notFound("a network sees no such pipette");
  if (proposed) found = detector.detect(frame_, eye_->lookCloser(frame_, kind, *proposed));
  if (found.second && found.second->isFound()) return found;
  const bool told = !detector.config().any_direction;
  if (!told && !proposal().glass.anywhere) return found;
  PipetteDetection other = detector.detect(frame_);
  if (!other.finding.hasValues()) return found;
  if (!told) judgeByGlass(other);
  return other.finding.isFound() || !found.finding.hasValues() ? other : found;
}

void FrameSearch::judgeByGlass(PipetteDetection& pipette) {
  const double shaft = std::max(kShaftWidths * pipette.half_width, kShortestShaft);
  const bool glass = proposal().glass.along(pipette.end, pipette.direction, shaft) >= kLeastGlass;
  pipette.second = glass ? Finding::found() : Finding::uncertain("a network sees no glass there");
  if (pipette.finding.isFound()) pipette.finding = *pipette.second;
}

}  // namespace microinjection
