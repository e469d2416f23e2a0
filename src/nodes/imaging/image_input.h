#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>
#include <string>

namespace microinjection {

/// Empty, or why an image must not be read: its size or length is wrong.
std::string imageDefect(const sensor_msgs::Image& message);

/// The pixels of a message: grey, BGR or BGRA, not copied; other colours and Bayer patterns become
/// grey of the same depth. Throws cv_bridge::Exception for a format that is not known. @pre
/// imageDefect() is empty
cv::Mat pixelsOf(const sensor_msgs::Image& message);

}  // namespace microinjection
