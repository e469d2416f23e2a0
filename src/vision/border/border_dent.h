#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/ellipse.h"

namespace microinjection {

/// The ellipse of a border without its dents: sectors in which a needle or a neighbour bends it, with as
/// much of the border beside them as deviates too. The fit as it is where there is no dent, or where
/// most of the border would be left out. Points that were left out are inliers where they are on the
/// ellipse all the same.
/// @param points     of the whole border (px), in order
/// @param tolerance  px, distance up to which a point belongs to the ellipse
EllipseFit withoutDents(const std::vector<cv::Point2d>& points, const EllipseFit& fit, double tolerance);

}  // namespace microinjection
