#include "nodes/imaging/image_output.h"

#include <cv_bridge/cv_bridge.h>
#include <image_transport/camera_common.h>
#include <sensor_msgs/image_encodings.h>

#include <stdexcept>

#include "nodes/imaging/image_input.h"

namespace microinjection {
namespace {

constexpr char kImageFrame[] = "microscope_optical_frame";
constexpr int kImageOutputQueue = 2;

}  // namespace

std::string imageEncoding(const cv::Mat& image) {
  switch (image.type()) {
    case CV_8UC1:
      return sensor_msgs::image_encodings::MONO8;
    case CV_16UC1:
      return sensor_msgs::image_encodings::MONO16;
    case CV_8UC3:
      return sensor_msgs::image_encodings::BGR8;
    case CV_16UC3:
      return sensor_msgs::image_encodings::BGR16;
    case CV_8UC4:
      return sensor_msgs::image_encodings::BGRA8;
    case CV_16UC4:
      return sensor_msgs::image_encodings::BGRA16;
    default:
      return "";
  }
}

ImageOutput::ImageOutput(Bus& bus)
    : images_(bus.advertiseImages(kImageTopic, kImageOutputQueue)),
      infos_(bus.advertise<sensor_msgs::CameraInfo>(image_transport::getCameraInfoTopic(bus.resolve(kImageTopic)),
                                                    kImageOutputQueue)) {}

void ImageOutput::publish(const cv::Mat& image, const ros::Time& stamp) {
  const std::string encoding = imageEncoding(image);
  if (encoding.empty()) throw std::invalid_argument("image: must be of 8 or 16 bit with 1, 3 or 4 channels");
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = kImageFrame;
  const auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  info->header = header;
  info->width = static_cast<std::uint32_t>(image.cols);
  info->height = static_cast<std::uint32_t>(image.rows);
  images_.publish(cv_bridge::CvImage(header, encoding, image).toImageMsg());
  infos_.publish(info);
}

}  // namespace microinjection
