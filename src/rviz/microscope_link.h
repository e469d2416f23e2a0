#pragma once

#include <cell_microinjection/VisionState.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <optional>

#include "operation/console/image_pairing.h"

namespace microinjection {

/// The images of the microscope, and what vision finds in them.
///
/// In: microscope/image_raw, while it is asked for; vision/state
///
/// The callbacks run in poll(), in the caller's thread. A reader that hangs loses images.
class MicroscopeLink {
 public:
  MicroscopeLink();
  /// Reads the images, or stops to, since they are the largest messages of a session.
  void listen(bool on);
  /// Runs the callbacks of the messages that came. Returns whether there is something new.
  bool poll();

  bool hasSource() const;  ///< a node publishes images, or what it finds in them
  /// The image to show; null before the first, or when none came for `kSilence`.
  sensor_msgs::ImageConstPtr image() const;
  /// What was found, if it is not old.
  std::optional<cell_microinjection::VisionState> specimen() const;

 private:
  static constexpr double kSilence = 2;  ///< s

  ImagePairing<sensor_msgs::ImageConstPtr> pairing_;
  cell_microinjection::VisionState specimen_;
  bool grown_ = false;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber images_, findings_;
};

}  // namespace microinjection
