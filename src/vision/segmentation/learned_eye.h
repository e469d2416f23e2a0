#pragma once

#include "vision/frame/proposal.h"
#include "vision/segmentation/segmenter.h"

namespace microinjection {

/// Cells and pipettes as the segmentation network sees them.
class LearnedEye : public SecondEye {
 public:
  /// With the weights that are built into the program.
  LearnedEye() = default;
  explicit LearnedEye(const std::string& weights) : segmenter_(weights) {}

  Proposal propose(const Frame& frame) override { return proposalOf(segmenter_.segment(frame)); }
  /// At a part of the frame about the pipette's end: its place is a third as coarse then.
  ProposedPipette lookCloser(const Frame& frame, const std::string& kind, const ProposedPipette& pipette) override;

  /// What a segmentation proposes. A cell is a region of ooplasm, with a zona where one is seen in most directions
  /// about it; a pipette is a long region that enters through the frame's border.
  static Proposal proposalOf(const Segmentation& segmentation);

 private:
  Segmenter segmenter_;
};

}  // namespace microinjection
