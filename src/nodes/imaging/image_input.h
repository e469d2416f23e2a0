#pragma once

#include <sensor_msgs/Image.h>
#include <opencv2/core/mat.hpp>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>

#include "base/config_reader.h"
#include "nodes/bus/bus.h"

namespace microinjection {

/// Empty, or why images cannot be received from a topic: it is one of a transport, such as /camera/image/compressed.
std::string topicDefect(const std::string& topic);

/// Takes the parameter of a node's transport (`image_transport`), which belongs to that library.
void acceptImageTransport(ConfigReader& reader);

/// Receives a camera's images and reports the exceptions of `handler`. Their stamps are not checked. While two nodes
/// send, no image counts, and both are named (of a packed transport, how many they are).
/// @throws ConfigError topicDefect()
Subscription subscribeImages(Bus& bus, const std::string& topic, std::uint32_t queue,
                             const std::function<void(const sensor_msgs::Image&)>& handler);

/// Empty, or why an image must not be read: its size or length is wrong, or it has no stamp.
std::string imageDefect(const sensor_msgs::Image& message);

/// The pixels of a message: grey, BGR or BGRA, not copied in the byte order of this computer; other colours and Bayer
/// patterns become grey of the same depth. Throws cv_bridge::Exception for a format that is not known. @pre
/// imageDefect() is empty
cv::Mat pixelsOf(const sensor_msgs::Image& message);

/// Empty, or why what began with images of one size (px, width and height) cannot go on with those of another. (0, 0):
/// not known.
inline std::string sizeChange(const Eigen::Vector2i& begun, const Eigen::Vector2i& now) {
  if (begun.isZero() || now.isZero() || begun == now) return "";
  const auto text = [](const Eigen::Vector2i& s) { return std::to_string(s.x()) + " x " + std::to_string(s.y()); };
  return "the images are of " + text(now) + " px now, and were of " + text(begun) +
         " px when this began: do not bin or crop them meanwhile, and begin anew";
}

/// The microscope's images (sensor_msgs/Image).
constexpr char kImageTopic[] = "microscope/image_raw";

}  // namespace microinjection
