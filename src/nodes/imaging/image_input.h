#pragma once

#include <sensor_msgs/Image.h>

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>

#include "nodes/bus/bus.h"

namespace microinjection {

/// Receives a camera's images and reports the exceptions of `handler`. Their stamps are not checked.
Subscription subscribeImages(Bus& bus, const std::string& topic, std::uint32_t queue,
                             const std::function<void(const sensor_msgs::Image&)>& handler);

/// Empty, or why an image must not be read: its size or length is wrong.
std::string imageDefect(const sensor_msgs::Image& message);

/// The pixels of a message: grey, BGR or BGRA, not copied; other colours and Bayer patterns become
/// grey of the same depth. Throws cv_bridge::Exception for a format that is not known. @pre
/// imageDefect() is empty
cv::Mat pixelsOf(const sensor_msgs::Image& message);

}  // namespace microinjection
