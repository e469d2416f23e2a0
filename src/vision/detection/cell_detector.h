#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/detection/cell_layers.h"
#include "vision/detection/polar_body.h"
#include "vision/detection/proposal.h"

namespace microinjection {

struct CellDetectorConfig {
  double smallest_diameter = 70;  ///< px, of the outermost border of a cell
  double largest_diameter = 600;  ///< px
  std::string look = "unknown";   ///< bright_field, phase, dic or unknown
  double least_coverage = 0.6;    ///< share of the border that must lie on its ellipse
  double most_outside = 0.1;      ///< share of the border that may be outside of the image without a warning

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
  void doubtOneOfTwo();

  /// The outermost border that was found.
  const CellBorder& outer() const { return zona_outer.finding.hasValues() ? zona_outer : ooplasm; }
};

/// Finds a cell in a frame: candidates by the votes of edges, closed borders by dynamic programming
/// in polar maps about them, ellipses by robust least squares. The border is the steepest place of
/// the grey value: from dark to bright outwards, in DIC either way. It does not know where needles are: under one
/// the verdicts are those of measureIndentation() (specimen_tracker.h).
class CellDetector {
 public:
  explicit CellDetector(const CellDetectorConfig& config);

  /// Searches the whole frame.
  CellDetection detect(const Frame& frame) const;
  /// Searches where a second eye sees cells. A cell is found where both eyes see the same outermost border; whose
  /// border that is, the cell's or its zona's, is what the fits say.
  CellDetection detect(const Frame& frame, const Proposal& proposal) const;
  /// Searches near a cell that was found in an earlier frame: moved by at most `reach` (px), of
  /// nearly the same size.
  CellDetection track(const Frame& frame, const CellDetection& previous, double reach) const;

 private:
  struct Seen {
    CellLayers layers;
    Finding finding;  ///< of the diameter
    Finding second;   ///< whether the second eye has nothing against it
    bool confirmed = false;
    static constexpr int kBest = 3;
    int rank() const {
      return (second.isFound() ? 2 : 0) + (finding.isFound() ? 1 : 0) - (finding.hasValues() ? 0 : 4);
    }
  };

  std::optional<Seen> seenAt(const Frame& frame, const ProposedCell& proposed) const;
  bool isClear(const CellBorder& border) const;
  /// Verdict of the diameter, but for what a bubble is.
  Finding judge(const CellLayers& layers) const;
  /// The same of what may be a bubble.
  Finding judgeRound(const Frame& frame, const CellLayers& layers) const;
  /// @param size  verdict of the diameter
  static void take(CellDetection& detection, const CellLayers& layers, const Finding& size);
  static void addOther(CellDetection& detection, const CellLayers& layers);

  CellDetectorConfig config_;
};

}  // namespace microinjection
