#include "nodes/imaging/image_input.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr std::uint32_t kLargestSide = 16384;  // px

}  // namespace

Subscription subscribeImages(Bus& bus, const std::string& topic, std::uint32_t queue,
                             const std::function<void(const sensor_msgs::Image&)>& handler) {
  return bus.subscribeImages(topic, queue, [&bus, topic, handler](const RawDelivery& delivery) {
    runGuarded(bus.refusals(), topic,
               [&] { handler(*static_cast<const sensor_msgs::Image*>(delivery.message.get())); });
  });
}

/// cv_bridge compares the length in 32 bits, and would read beyond a short one.
std::string imageDefect(const sensor_msgs::Image& message) {
  const bool good = message.width <= kLargestSide && message.height <= kLargestSide &&
                    std::uint64_t{message.height} * message.step == message.data.size();
  return good ? "" : "its size or length is wrong";
}

cv::Mat pixelsOf(const sensor_msgs::Image& message) {
  namespace encodings = sensor_msgs::image_encodings;
  const auto unowned = boost::shared_ptr<void const>();
  const std::string& encoding = message.encoding;
  const bool is_bgr = encoding.rfind("bgr", 0) == 0;
  const bool is_other = encodings::isBayer(encoding) || encoding == encodings::YUV422 || encodings::isColor(encoding);
  if (is_bgr || !is_other) return cv_bridge::toCvShare(message, unowned)->image;
  const bool is_deep = encoding != encodings::YUV422 && encodings::bitDepth(encoding) == 16;
  return cv_bridge::toCvCopy(message, is_deep ? encodings::MONO16 : encodings::MONO8)->image;
}

}  // namespace microinjection
