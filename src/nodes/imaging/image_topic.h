#pragma once

namespace microinjection {

/// The microscope's images (sensor_msgs/Image).
constexpr char kImageTopic[] = "microscope/image_raw";

}  // namespace microinjection
