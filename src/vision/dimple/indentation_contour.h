#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/border/cell_border.h"
#include "vision/dimple/border_displacement.h"
#include "vision/frame/finding.h"
#include "vision/frame/frame.h"
#include "vision/pipette/pipette_detector.h"

namespace microinjection {

/// The outline of a cell where a needle presses on it.
struct Dimple {
  Finding finding;
  double depth = 0;            ///< px, along the needle, from the undisturbed outline to the deepest place
  double deviation = 0;        ///< px, standard deviation
  cv::Point2d deepest;         ///< px
  Ellipse outline;             ///< px, undisturbed
  bool at_cell = false;        ///< the tip is at the border or within it, which it may bend
  bool outline_found = false;  ///< the border is this outline with a dimple, whether the depth is sure or not
  Eigen::Matrix2d centre_covariance = Eigen::Matrix2d::Zero();  ///< px^2, of the outline's centre
  std::vector<cv::Point2d> contour;                             ///< px, of the part that faces the needle
  BorderDisplacement displacement;  ///< of the outline beside the needle; it has its own finding
};

/// Follows the outer border of a cell through the dimple under a needle. The needle hides the border
/// at the tip itself and behind it. Where the parabola through what is seen on both sides leads to the
/// tip, the needle touches and its tip is the deepest place; elsewhere the finding is uncertain.
/// @param border     the undisturbed outline: its ellipse describes the rest of the cell
/// @param tip        px
/// @param direction  rad, from the tip towards the shaft, from x towards y
/// @param width      px, of the needle near its tip
Dimple findIndentation(const Frame& frame, const CellBorder& border, const cv::Point2d& tip, double direction,
                       double width);

/// The same under a needle that was found: kNotFound without one, and at most kUncertain under one
/// that is uncertain. The deviation includes that of the tip. The displacement is measured above the
/// cell too.
Dimple findIndentation(const Frame& frame, const CellBorder& border, const PipetteDetection& needle);

}  // namespace microinjection
