#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "vision/frame/ellipse.h"

namespace microinjection {

/// A needle's axis in the image, from its tip towards the shaft.
struct NeedleAxis {
  cv::Point2d tip;       ///< px
  double direction = 0;  ///< rad, from x towards y
  cv::Point2d along() const;
  cv::Point2d across() const;
};

/// A place where a border was seen.
struct BorderPoint {
  cv::Point2d place;     ///< px
  cv::Point2d normal;    ///< of unit length, across the border
  bool facing = false;   ///< in the part of the border that the needle may displace
  bool trusted = false;  ///< of clear contrast and not hidden by the needle
};

/// An ellipse with a dent along a needle's axis. At the distance s from the axis the border is displaced
/// by depth (1 + tail (s / width)^2)^(-1 / (2 tail)): a bell curve for tail 0, and for tail 1 it falls
/// off as 1 / s, as the surface of an elastic half space does beside a punch. The displacement fades
/// towards the ellipse's sides.
struct DentedEllipse {
  bool valid = false;
  Ellipse ellipse;                                              ///< px, undisturbed
  double depth = 0, width = 0;                                  ///< px
  double tail = 0;                                              ///< 0..1
  double residual = 0;                                          ///< px, robust standard deviation of the points
  double top_deviation = 0;                                     ///< px, of the undisturbed border on the axis, along it
  double depth_deviation = 0;                                   ///< px
  Eigen::Matrix2d centre_covariance = Eigen::Matrix2d::Zero();  ///< px^2, of the ellipse's centre
  std::vector<bool> used;                                       ///< of each point: the model describes it

  /// px from the tip along the axis to the undisturbed border.
  double top(const NeedleAxis& axis) const;
  /// Displacement (px, into the ellipse) at a distance across the axis where the undisturbed border is.
  double displacement(const NeedleAxis& axis, double across) const;
};

/// Fits it to the points by least squares with Tukey's weights.
/// @param start  px, roughly the undisturbed border
DentedEllipse fitDentedEllipse(const std::vector<BorderPoint>& points, const NeedleAxis& axis, const Ellipse& start);
/// @param start  an earlier fit
DentedEllipse fitDentedEllipse(const std::vector<BorderPoint>& points, const NeedleAxis& axis,
                               const DentedEllipse& start);

}  // namespace microinjection
