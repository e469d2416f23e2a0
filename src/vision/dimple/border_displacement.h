#pragma once

#include <opencv2/core.hpp>

#include "vision/border/cell_border.h"
#include "vision/frame/finding.h"
#include "vision/frame/frame.h"

namespace microinjection {

/// How the outline of a cell gives way to a needle above it or on it.
struct BorderDisplacement {
  Finding finding;       ///< of all that follows
  double depth = 0;      ///< px, that the outline gave way under the tip, by its displacement beside the needle
  double deviation = 0;  ///< px, standard deviation
  double gap = 0;        ///< px along the needle, from the undisturbed outline to the tip; negative: it is deeper
};

/// Measures the displacement of a cell's outline on both sides of a needle. The needle hides the place
/// where it touches, and a dimple is narrow: under a flat end of half width a, an elastic half space
/// gives way by depth (2 / pi) asin(a / s) at the distance s from the axis (Boussinesq's rigid punch;
/// Johnson, Contact Mechanics, 1985, 3.36). This shape is fitted to the steepest places of the outline,
/// together with the place and the slant of the undisturbed outline: its ellipse is not exact to a
/// fraction of a pixel everywhere.
/// On a real cell `depth` is proportional to the true depth rather than equal to it, and an outline that
/// is no ellipse adds up to 1.5 px that stay the same in an approach.
/// @param border       gives polarity and place of the outline
/// @param tip          px
/// @param direction    rad, from the tip towards the shaft, from x towards y
BorderDisplacement findDisplacement(const Frame& frame, const CellBorder& border, const cv::Point2d& tip,
                                    double direction);

/// Half of the needle's width (px) a little behind its tip, by its outermost clear edges; 0 when it has none.
double needleHalfWidth(const Frame& frame, const cv::Point2d& tip, double direction);

}  // namespace microinjection
