#pragma once

#include <image_transport/image_transport.h>
#include <ros/ros.h>

#include <opencv2/core/mat.hpp>
#include <string>

namespace microinjection {

/// Publishes frames of the microscope's camera: microscope/image_raw and microscope/camera_info,
/// with image_transport. Frame: microscope_optical_frame (x right, y down, z into the picture).
///
/// A microscope has parallel rays, for which camera_info has no model: its matrices are 0, which
/// means "not calibrated". The calibration of the manipulator joins pixels and needle instead.
class ImageOutput {
 public:
  explicit ImageOutput(ros::NodeHandle& node);

  bool wanted() const { return publisher_.getNumSubscribers() > 0; }
  /// @param image  8 or 16 bit; grey, BGR or BGRA. Throws std::invalid_argument for another one.
  void publish(const cv::Mat& image, const ros::Time& stamp);

 private:
  image_transport::ImageTransport transport_;
  image_transport::CameraPublisher publisher_;
};

/// Name of a picture's format in sensor_msgs/Image; empty for one that has none here.
std::string imageEncoding(const cv::Mat& image);

}  // namespace microinjection
