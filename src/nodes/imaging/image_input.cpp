#include "nodes/imaging/image_input.h"

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>

#include <memory>
#include <utility>

#include "base/errors.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/sole_sender.h"

namespace microinjection {
namespace {

constexpr std::uint32_t kLargestSide = 16384;  // px

bool isLittleEndian() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const unsigned char*>(&one) == 1;
}

/// The same image in the byte order of this computer. @pre its levels have 16 bit
sensor_msgs::Image swapped(const sensor_msgs::Image& message) {
  sensor_msgs::Image image = message;
  for (std::size_t i = 0; i + 1 < image.data.size(); i += 2) std::swap(image.data[i], image.data[i + 1]);
  image.is_bigendian = static_cast<std::uint8_t>(!isLittleEndian());
  return image;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::string topicDefect(const std::string& topic) {
  for (const std::string transport : {"compressed", "compressedDepth", "theora"}) {
    if (!endsWith(topic, "/" + transport)) continue;
    const std::string image = topic.substr(0, topic.size() - transport.size() - 1);
    return topic + ": has no images, but what a transport makes of them. Unpack it: rosrun image_transport republish " +
           transport + " in:=" + image + " raw out:=" + image + "_unpacked, and take " + image + "_unpacked";
  }
  return "";
}

void acceptImageTransport(ConfigReader& reader) {
  std::string transport;
  reader.text("image_transport", transport);
}

Subscription subscribeImages(Bus& bus, const std::string& topic, std::uint32_t queue,
                             const std::function<void(const sensor_msgs::Image&)>& handler) {
  if (const std::string defect = topicDefect(bus.resolve(topic)); !defect.empty()) throw ConfigError(defect);
  const auto senders = std::make_shared<SoleSender>();
  return bus.subscribeImages(topic, queue, [&bus, topic, handler, senders](const RawDelivery& delivery) {
    const std::string refusal = senders->refusalOf(delivery.sender, delivery.received);
    if (!refusal.empty()) return bus.refusals().add(topic, refusal);
    runGuarded(bus.refusals(), topic,
               [&] { handler(*static_cast<const sensor_msgs::Image*>(delivery.message.get())); });
  });
}

/// cv_bridge compares the length in 32 bits, and would read beyond a short one.
std::string imageDefect(const sensor_msgs::Image& message) {
  const bool good = message.width <= kLargestSide && message.height <= kLargestSide &&
                    std::uint64_t{message.height} * message.step == message.data.size();
  if (!good) return "its size or length is wrong";
  return message.header.stamp.isZero() ? "it has no stamp: the driver must stamp each image" : "";
}

cv::Mat pixelsOf(const sensor_msgs::Image& message) {
  namespace encodings = sensor_msgs::image_encodings;
  const auto unowned = boost::shared_ptr<void const>();
  const std::string& encoding = message.encoding;
  const bool is_wide = encoding != encodings::YUV422 && encodings::bitDepth(encoding) == 16;
  if (is_wide && (message.is_bigendian != 0) == isLittleEndian()) return pixelsOf(swapped(message)).clone();
  const bool is_bgr = encoding.rfind("bgr", 0) == 0;
  const bool is_other = encodings::isBayer(encoding) || encoding == encodings::YUV422 || encodings::isColor(encoding);
  if (is_bgr || !is_other) return cv_bridge::toCvShare(message, unowned)->image;
  return cv_bridge::toCvCopy(message, is_wide ? encodings::MONO16 : encodings::MONO8)->image;
}

}  // namespace microinjection
