#pragma once

#include <optional>

#include "vision/frame/proposal.h"
#include "vision/layers/cell_detector.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {

/// Searches of one frame, at which a second eye looks once at most, when the first thing is searched. A cell is
/// searched where that eye sees one. So is a pipette. Where it sees none, since a thin one is too fine for it, a
/// pipette whose direction is told is searched in the whole frame; without a direction only where glass is seen, and it
/// is sure only if glass is seen along its shaft. Whatever way it was searched, an end that the eye sees elsewhere, or
/// that is on a pipette of the other kind, is not sure.
class FrameSearch {
 public:
  /// @param eye  none: the whole frame is searched
  FrameSearch(const Frame& frame, SecondEye* eye) : frame_(frame), eye_(frame.refusal().empty() ? eye : nullptr) {}

  CellDetection cell(const CellDetector& detector);
  PipetteDetection pipette(const PipetteDetector& detector);

 private:
  const Proposal& proposal();
  bool isGlass(const PipetteDetection& pipette);

  const Frame& frame_;
  SecondEye* eye_;
  std::optional<Proposal> proposal_;
};

}  // namespace microinjection
