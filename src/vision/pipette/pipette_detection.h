#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

#include "vision/frame/finding.h"

namespace microinjection {

struct PipetteDetection {
  Finding finding;
  cv::Point2d end;                                       ///< px, tip, or middle of the mouth
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2, of the end
  double direction = 0;                                  ///< rad, from the end towards the shaft, from x towards y
  double direction_deviation = 0;                        ///< rad, standard deviation
  double half_width = 0;                                 ///< px, of the outline near the end
  double taper = 0;                                      ///< growth of the half width along the axis
  double symmetry = 0;                                   ///< 0..1, of the edges near the end
  std::optional<Finding> second;                         ///< whether a second eye sees the same; none: there was none
  double clearness = 0;                                  ///< of the end: edges before it over edges behind it
  bool which_end = false;                                ///< uncertain, since its end may be another edge
  std::optional<double> confirmed;  ///< clearness of an end, when a second eye has told which edge it is

  /// Sets the covariance of the end for the direction as it is.
  /// @param along, across  px, standard deviations
  void setCovariance(double along, double across);
  /// What a second eye has against it, found: nothing. What it doubts is not sure.
  void hear(const Finding& second_eye);
  /// The edge is the end, as a second eye sees it: one that was in doubt is found, as exactly as that edge is wide.
  void confirm();
  /// px, of a place from the end: along the axis towards the shaft, and across.
  cv::Point2d inAxes(const cv::Point2d& place) const;
  double deviationAlong() const;  ///< px, standard deviation of the end along the axis
};

}  // namespace microinjection
