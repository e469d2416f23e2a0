#pragma once

#include <cell_microinjection/VisionState.h>
#include <sensor_msgs/Image.h>

#include <optional>

#include "nodes/bus/bus.h"
#include "operation/console/image_pairing.h"

namespace microinjection {

/// The images of the microscope, and what vision finds in them.
///
/// In: microscope/image_raw, while it is asked for; vision/state
///
/// A reader that hangs loses images.
class MicroscopeLink {
 public:
  explicit MicroscopeLink(Bus& bus);
  /// Reads the images, or stops to, since they are the largest messages of a session.
  void listen(bool on);
  /// Handles the messages that came. Returns whether there is something new.
  bool poll();

  bool hasSource() const;  ///< a node publishes images, or what it finds in them
  /// The image to show; null before the first, or when none came for `kSilence`.
  sensor_msgs::ImageConstPtr image() const;
  /// What was found, if it is not old.
  std::optional<cell_microinjection::VisionState> specimen() const;

 private:
  static constexpr double kSilence = 2;  ///< s

  double now() const { return bus_.steady().toSec(); }  ///< s; the nodes of the microscope live in wall time

  Bus& bus_;
  ImagePairing<sensor_msgs::ImageConstPtr> pairing_;
  cell_microinjection::VisionState specimen_;
  bool grown_ = false;
  Subscription images_, findings_;
};

}  // namespace microinjection
