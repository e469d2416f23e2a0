#pragma once

#include <visualization_msgs/InteractiveMarker.h>

#include <string>

namespace microinjection {

/// The handle's name among the interactive markers of /hand_marker.
constexpr char kHandMarker[] = "hand";

/// A ball for dragging in the view's plane and an arrow along each axis, in display units around
/// the origin of `frame`.
visualization_msgs::InteractiveMarker handMarker(const std::string& frame);

}  // namespace microinjection
