#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/frame/contrast_mode.h"
#include "vision/frame/proposal.h"
#include "vision/layers/cell_layers.h"
#include "vision/layers/polar_body.h"

namespace microinjection {

struct CellDetectorConfig {
  double smallest_diameter = 70;  ///< px, of the outermost border of a cell
  double largest_diameter = 600;  ///< px
  ContrastMode contrast_mode = ContrastMode::kUnknown;
  double least_coverage = 0.6;  ///< share of the border that must lie on its ellipse
  double most_outside = 0.1;    ///< share of the border that may be outside of the image without a warning

  static CellDetectorConfig read(ConfigReader& reader);
};

struct CellDetection {
  Finding finding;                                              ///< of the cell and of its centre
  Finding size;                                                 ///< of its diameter: never surer than the cell
  cv::Point2d centre;                                           ///< px
  Eigen::Matrix2d centre_covariance = Eigen::Matrix2d::Zero();  ///< px^2
  CellBorder zona_outer, zona_inner, ooplasm;                   ///< a cell without zona has only the last
  PolarBody polar_body;
  std::vector<OtherThing> others;  ///< other whole cells; with a second eye bubbles and debris, too
  bool held = false;               ///< a second eye sees it at the holding pipette: others do not make it uncertain
  std::optional<Finding> second;   ///< whether a second eye has nothing against it; none: there was none
  double agreed_diameter = 0;      ///< px, of the outermost border when the second eye looked; 0: it did not
  bool confirmed = false;          ///< it sees a zona with its outer border in the same place

  /// Removes the others for whose ellipse `part_of_another_thing` is true. Without other cells the one cell is
  /// certain again.
  template <typename Predicate>
  void dismissOthers(const Predicate& part_of_another_thing) {
    const auto isPart = [&](const OtherThing& thing) { return part_of_another_thing(thing.ellipse); };
    others.erase(std::remove_if(others.begin(), others.end(), isPart), others.end());
    for (Finding* doubted : {&finding, &size}) {
      if (otherCells() == 0 && doubted->reason == kTwoCells) *doubted = Finding::found();
    }
  }

  static constexpr const char* kTwoCells = "two cells: the clearest is given";

  std::ptrdiff_t otherCells() const {
    return std::count_if(others.begin(), others.end(), [](const OtherThing& thing) { return thing.isCell(); });
  }

  /// Of two cells neither is sure, unless it is the one that is held.
  void markAmbiguous();

  /// The outermost border that was found.
  const CellBorder& outer() const { return zona_outer.finding.hasValues() ? zona_outer : ooplasm; }
};

/// Finds a cell in a frame, and the borders that it consists of.
///
///     frame --+-- votes of edges for centres --+--> candidates --> lines of each --> layers of each line --> verdict
///             '-- what a second eye proposes --'                   (closed paths)    (ellipses, one fit)
///
/// The way goes in one direction: a candidate is a place, a fit is what was measured there, and only detect() decides
/// which fit is the cell, which are others, and how sure that is. Where a second eye has proposed the places, it is
/// also a witness: it knows what a cell looks like and tells places to some pixels, whereas the fits tell them to a
/// tenth of a pixel and take any dark ring for a cell. So neither is believed alone. A cell is found where both have
/// the same outermost border; whose border that is, the cell's or its zona's, is what the fits say, because the second
/// eye overlooks thin zonae.
///
/// A closed border is the path of the steepest slopes in a polar map about the candidate, by dynamic programming, and
/// an ellipse is fitted to that path. A fit to all edge points at once would mix the lines of halo, zona and ooplasm,
/// which lie within a tenth of the radius; the path stays on one of them. The border is the steepest place of the grey
/// value: from dark to bright outwards, in DIC either way.
///
/// The detector does not know where needles are: under one the verdicts are those of measureIndentation()
/// (track/specimen_tracker.h).
class CellDetector {
 public:
  explicit CellDetector(const CellDetectorConfig& config);

  /// Searches the whole frame.
  /// @param proposal  where a second eye sees cells; then only these places are searched. Null: there is none
  CellDetection detect(const Frame& frame, const Proposal* proposal = nullptr) const;
  /// Searches near a cell that was found in an earlier frame: moved by at most `reach` (px), of
  /// nearly the same size.
  CellDetection track(const Frame& frame, const CellDetection& previous, double reach) const;

 private:
  struct Candidate;
  struct Fit;

  /// @param why_none  what the verdict is if none of them is a cell
  std::vector<Candidate> votedCandidates(const Frame& frame, std::string& why_none) const;
  std::vector<Candidate> proposedCandidates(const Proposal& proposal, std::string& why_none) const;
  /// The clear borders at a candidate, the clearest first.
  std::vector<CellBorder> linesOf(const Frame& frame, const Candidate& candidate) const;
  /// The best of the fits that begin at the candidate's lines.
  Fit fit(const Frame& frame, const Candidate& candidate) const;
  /// The fit is the cell.
  void adopt(CellDetection& detection, const Frame& frame, const Candidate& candidate, const Fit& fit) const;
  /// The layers are those of the cell of an earlier frame.
  void follow(CellDetection& detection, const Frame& frame, const CellDetection& previous, CellLayers& layers) const;
  bool isClear(const CellBorder& border) const;
  /// Verdict of the diameter, but for what a bubble is.
  Finding judge(const CellLayers& layers) const;
  /// The same of what may be a bubble.
  Finding judgeRound(const Frame& frame, const CellLayers& layers) const;
  /// @param size  verdict of the diameter
  static void take(CellDetection& detection, const CellLayers& layers, const Finding& size);

  CellDetectorConfig config_;
};

}  // namespace microinjection
