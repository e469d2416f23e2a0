#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/frame.h"

namespace microinjection {

/// Where a pipette may be, roughly. Its outline is two straight lines that are symmetric to its axis.
struct PipetteAxis {
  cv::Point2d point;      ///< px, on the axis, the nearest to the region's centre
  double direction = 0;   ///< rad, of the axis, from x towards y; as yet either way
  double half_width = 0;  ///< px, of the outline at `point`
  double taper = 0;       ///< growth of the half width along the direction
  double weight = 0;      ///< of its edges

  /// px, half width of the outline beside a place.
  double outlineAt(const cv::Point2d& place) const;
  /// px, where the axis, followed from its point towards the shaft, leaves the frame.
  cv::Point2d entry(const Frame& frame) const;
};

struct AxisSearch {
  double direction = 0;          ///< rad, from the pipette's end towards its shaft, from x towards y
  double tolerance = 0.5;        ///< rad, of the direction
  double steepest_taper = 0.45;  ///< rad, of an outline's line to the axis
  double widest = 500;           ///< px, of an outline
  int finer = 0;                 ///< levels of the frame above the usual one, for pipettes of which little is seen
  cv::Rect region;               ///< px, that is searched; empty: the half of the frame that the shaft comes from
  double from_border = 0;        ///< px along the direction, of that half, beside the frame's border; 0: all of it
};

/// Finds axes by straight edges (Hough) and the axis of symmetry of each two of them. Best first.
std::vector<PipetteAxis> findPipetteAxes(const Frame& frame, const AxisSearch& search, int most);

}  // namespace microinjection
