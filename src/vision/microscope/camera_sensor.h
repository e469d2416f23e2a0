#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "vision/microscope/microscope_config.h"

namespace microinjection {

/// The light on the camera, and the camera itself.
class CameraSensor {
 public:
  explicit CameraSensor(const MicroscopeConfig& config);

  /// Returns the picture, CV_8U or CV_16U, of the share of the illumination that reaches each pixel
  /// (CV_32F). A level of mean m has the variance (m + read_noise^2 / gain) / gain before it is
  /// rounded: shot noise is taken as normal, which holds above some 20 electrons.
  cv::Mat expose(const cv::Mat& transmission, std::uint64_t seed) const;

  const cv::Mat& illumination() const { return illumination_; }  ///< CV_32F, grey levels

 private:
  SensorConfig config_;
  cv::Mat illumination_;
  /// Standard normal deviates, of which each row of a picture takes a run at a place, in a direction
  /// and with a sign of its own. Drawing them anew would take most of the time of a picture.
  std::vector<float> normals_;
};

}  // namespace microinjection
