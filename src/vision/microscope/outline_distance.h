#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace microinjection {

/// Signed distances of the pixels around a closed outline.
struct OutlineDistance {
  cv::Rect region;   ///< of the image; empty when nothing of the outline or its band is in it
  cv::Mat distance;  ///< CV_32F, px, of the region: positive inside; cut beyond the band
};

/// Signed distances to a closed polygon (px, at least three corners, in either sense, need not be
/// convex). The region is the polygon's box and `band` px around it, within the image. Exact where
/// the distance is below 10 px. Farther away it is interpolated on a grid of 4 px: its error is
/// below 2 / (distance from a centre of curvature) px.
OutlineDistance outlineDistance(const std::vector<Eigen::Vector2d>& outline, double band, const cv::Size& image);

}  // namespace microinjection
