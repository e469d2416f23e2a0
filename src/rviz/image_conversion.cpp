#include "rviz/image_conversion.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <cstdint>

namespace microinjection {
namespace {

constexpr std::uint32_t kLargestSide = 16384;  // px

}  // namespace

QImage toPicture(const sensor_msgs::Image& message, QString& defect) {
  namespace encodings = sensor_msgs::image_encodings;
  // cv_bridge compares the length in 32 bits, and would read beyond a short one.
  const bool sized = message.width > 0 && message.height > 0 && message.width <= kLargestSide &&
                     message.height <= kLargestSide &&
                     std::uint64_t{message.height} * message.step == message.data.size();
  if (!sized) {
    defect = "its size or length is wrong";
    return {};
  }
  try {
    const auto source = cv_bridge::toCvShare(message, boost::shared_ptr<void const>());
    cv_bridge::CvtColorForDisplayOptions options;
    options.do_dynamic_scaling = encodings::bitDepth(message.encoding) > 8;
    const bool grey = message.encoding == encodings::MONO8;
    const cv::Mat pixels =
        grey ? source->image : cv_bridge::cvtColorForDisplay(source, encodings::RGB8, options)->image;
    const auto format = grey ? QImage::Format_Grayscale8 : QImage::Format_RGB888;
    return QImage(pixels.data, pixels.cols, pixels.rows, static_cast<int>(pixels.step), format).copy();
  } catch (const std::exception& error) {  // cv_bridge's and OpenCV's
    defect = error.what();
    return {};
  }
}

}  // namespace microinjection
