#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "vision/border/cell_border.h"
#include "vision/dimple/dented_ellipse.h"
#include "vision/frame/frame.h"

namespace microinjection {

constexpr double kBesideNeedle = 3;  // px, that its edge blurs

/// The strip along a needle, before its tip too, in which a border is not seen where the needle touches it.
struct NeedleShadow {
  NeedleAxis axis;
  double half_width = 0;  ///< px, near the tip
  double taper = 0;       ///< growth of the half width along the axis
  bool hides(const cv::Point2d& point) const;
};

/// Closed path (px) along a border that a needle may have displaced: by dynamic programming in a polar
/// map, through the dent on the side of the needle and near the border's ellipse elsewhere.
std::vector<cv::Point2d> findOutline(const Frame& frame, const CellBorder& border, const NeedleShadow& needle);

/// Closed path (px) along a dented ellipse.
std::vector<cv::Point2d> outlineOf(const DentedEllipse& dented, const NeedleAxis& axis);

/// The border near a closed path, to a fraction of a pixel: its flanks' steepest places across the
/// path, and between them as `border` has them. Each point is trusted where the needle does not hide it
/// and a flank is clear.
/// @param flank   px, of the rising flank outside of the path
/// @param window  px, to both sides of the flank
std::vector<BorderPoint> traceOutline(const Frame& frame, const CellBorder& border, const NeedleShadow& needle,
                                      const std::vector<cv::Point2d>& path, double flank, double window);

}  // namespace microinjection
