#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/detection/finding.h"
#include "vision/detection/pipette_axis.h"
#include "vision/detection/pipette_strip.h"

namespace microinjection {

struct PipetteDetectorConfig {
  std::string kind = "injection";  ///< injection: a tip; holding: a blunt mouth
  double direction = -M_PI / 2;    ///< rad in the image, from the end towards the shaft, from x towards y
  double tolerance = 0.5;          ///< rad, of the direction
  double widest = 500;             ///< px, diameter of the part that is in the image
  Eigen::Vector4d region = Eigen::Vector4d::Zero();  ///< px, x, y, width, height of the part of the frame with the
                                                     ///< pipette; width 0: the half that the shaft comes from

  static PipetteDetectorConfig read(ConfigReader& reader);
};

struct PipetteDetection {
  Finding finding;
  cv::Point2d end;                                       ///< px, tip, or middle of the mouth
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2, of the end
  double direction = 0;                                  ///< rad, from the end towards the shaft, from x towards y
  double direction_deviation = 0;                        ///< rad, standard deviation
  double half_width = 0;                                 ///< px, of the outline near the end
  double taper = 0;                                      ///< growth of the half width along the axis
  double symmetry = 0;                                   ///< 0..1, of the edges near the end
  double clearness = 0;                                  ///< of the end: edges before it over edges behind it
};

/// Finds a pipette that enters the frame through its border: its axis of symmetry, and the place
/// along it where the walls end. To a fraction of a pixel in focus.
class PipetteDetector {
 public:
  explicit PipetteDetector(const PipetteDetectorConfig& config);

  /// Searches the whole frame, or the region.
  PipetteDetection detect(const Frame& frame) const;
  /// Searches near a pipette that was found in an earlier frame: its end moved by at most `reach` (px).
  PipetteDetection track(const Frame& frame, const PipetteDetection& previous, double reach) const;

 private:
  PipetteDetection measure(const Frame& frame, const PipetteAxis& axis) const;
  void take(PipetteDetection& best, const PipetteDetection& found) const;
  PipetteDetection measureHolding(const Frame& frame, PipetteAxis axis) const;
  PipetteDetection refineHolding(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach,
                                 int rounds) const;
  PipetteDetection refine(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach) const;

  PipetteDetectorConfig config_;
};

}  // namespace microinjection
