#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>
#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Publishes frames of the microscope's camera: microscope/image_raw and microscope/camera_info.
/// Frame: microscope_optical_frame (x right, y down, z into the picture).
///
/// A microscope has parallel rays, for which camera_info has no model: its matrices are 0, which
/// means "not calibrated". The calibration of the manipulator joins pixels and needle instead.
class ImageOutput {
 public:
  explicit ImageOutput(Bus& bus);

  bool wanted() const { return images_.subscribers() > 0 || infos_.subscribers() > 0; }
  /// @param image  8 or 16 bit; grey, BGR or BGRA. Throws std::invalid_argument for another one.
  void publish(const cv::Mat& image, const ros::Time& stamp);

 private:
  Publisher<sensor_msgs::Image> images_;
  Publisher<sensor_msgs::CameraInfo> infos_;
};

/// Name of a picture's format in sensor_msgs/Image; empty for one that has none here.
std::string imageEncoding(const cv::Mat& image);

}  // namespace microinjection
