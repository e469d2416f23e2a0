#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"
#include "vision/frame/proposal.h"
#include "vision/pipette/pipette_axis.h"
#include "vision/pipette/pipette_detection.h"

namespace microinjection {

struct PipetteDetectorConfig {
  std::string kind = "injection";  ///< injection: a tip; holding: a blunt mouth
  double direction = -M_PI / 2;    ///< rad in the image, from the end towards the shaft, from x towards y
  bool any_direction = false;      ///< where a second eye sees a pipette, it may come from anywhere
  double tolerance = 0.5;          ///< rad, of the direction
  double widest = 500;             ///< px, diameter of the part that is in the image
  Eigen::Vector4d region = Eigen::Vector4d::Zero();  ///< px, x, y, width, height of the part of the frame with the
                                                     ///< pipette; width 0: the half that the shaft comes from

  static PipetteDetectorConfig read(ConfigReader& reader);
};

/// Finds a pipette that enters the frame through its border: its axis of symmetry, and the place along it where the
/// walls end. To a fraction of a pixel in focus.
///
///     border of       |==========================.         walls: two lines, symmetric to the axis
///     the frame       |- - - - - axis - - - - - - o end    the tip, or the middle of a holding pipette's mouth
///                     |=========================='         `direction` goes from the end to the shaft: here, left
///
///     straight edges --> axes of symmetry --> injection:  where edges end --> fit of a tube's end --+--> verdict
///     (pipette_axis.h)   the best few         holding:    walls inwards --> an arc at each lip -----'
///
/// A pipette is known by its symmetry and not by its grey values, because glass is dark, bright or both, by focus and
/// contrast mode, while two walls are mirror images in all of them, but for the sign of their edges. Its end is fitted
/// to all grey values around it: where a threshold on edges put it, tips below 4 px were up to 3 px off without a
/// warning, and the fit has a likelihood that says when the end fades. Edges are searched in a reduced frame first, and
/// in finer ones only where too little is seen, since each costs four times as much.
///
/// A scale bar is as straight as a needle. So where a second eye (proposal.h) sees a pipette, the detector searches
/// there, and what is found is sure only where both see the end in the same place. Who proposes does not measure, and
/// who measures does not say what it is (doc/design/detection.md).
///
/// A detector has no state beside its configuration: functions may be called for any frame, in any thread that has
/// the frame to itself.
class PipetteDetector {
 public:
  explicit PipetteDetector(const PipetteDetectorConfig& config);

  const PipetteDetectorConfig& config() const { return config_; }

  /// Searches the region that is told; without one, the half of the frame that the shaft comes from.
  PipetteDetection detect(const Frame& frame) const;
  /// Searches where a second eye sees a pipette. It is found where both eyes see its end in the same place; where
  /// nothing is measured, it is not found.
  PipetteDetection detect(const Frame& frame, const ProposedPipette& proposed) const;
  /// Whether the one that is searched may be there, by what is told of direction and region.
  bool isAllowed(const ProposedPipette& proposed) const;
  /// Whether the end that was measured is the one that a second eye sees.
  bool isAtEnd(const PipetteDetection& pipette, const ProposedPipette& proposed) const;
  static constexpr const char* kSeenElsewhere = "a network sees its end elsewhere";

  /// Searches near a pipette that was found in an earlier frame: its end moved by at most `reach` (px).
  PipetteDetection track(const Frame& frame, const PipetteDetection& previous, double reach) const;

 private:
  /// Whether an end that a second eye has told is the same edge in the next frame.
  static bool isSameEdge(const PipetteDetection& before, const PipetteDetection& now);
  /// Whether a mouth is so near to the proposed one that this tells which of several edges it is.
  bool isSameMouth(const PipetteDetection& pipette, const ProposedPipette& proposed) const;
  cv::Rect region() const;  ///< that is told; empty: none
  AxisSearch searchAt(const Frame& frame, const ProposedPipette& proposed) const;
  PipetteDetection search(const Frame& frame, AxisSearch search, int finest) const;
  PipetteDetection refine(const Frame& frame, const PipetteAxis& axis, const cv::Point2d& end, double reach,
                          int rounds) const;
  PipetteDetection measure(const Frame& frame, const PipetteAxis& axis) const;
  /// Keeps the better one of two axes' pipettes.
  void take(PipetteDetection& best, const PipetteDetection& found) const;

  PipetteDetectorConfig config_;
};

}  // namespace microinjection
