#include "nodes/haptic/hand_marker.h"

#include <cmath>

namespace microinjection {
namespace {

using visualization_msgs::InteractiveMarkerControl;

constexpr double kSize = 0.3;  // display units, of the arrows
constexpr double kBall = 0.1;  // display units, diameter

/// A control moves along the x axis of its orientation; rviz draws the arrows.
InteractiveMarkerControl axisControl(const std::string& name, double x, double y, double z) {
  InteractiveMarkerControl control;
  control.name = name;
  control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
  control.orientation.w = std::sqrt(0.5);
  control.orientation.x = std::sqrt(0.5) * x;
  control.orientation.y = std::sqrt(0.5) * y;
  control.orientation.z = std::sqrt(0.5) * z;
  return control;
}

InteractiveMarkerControl ballControl() {
  visualization_msgs::Marker ball;
  ball.type = visualization_msgs::Marker::SPHERE;
  ball.pose.orientation.w = 1;
  ball.scale.x = ball.scale.y = ball.scale.z = kBall;
  ball.color.r = 1.0F;
  ball.color.g = 0.75F;
  ball.color.b = 0.2F;
  ball.color.a = 0.9F;
  InteractiveMarkerControl control;
  control.name = "ball";
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.orientation.w = 1;
  control.always_visible = true;
  control.markers.push_back(ball);
  return control;
}

}  // namespace

visualization_msgs::InteractiveMarker handMarker(const std::string& frame) {
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = frame;
  marker.name = kHandMarker;
  marker.scale = static_cast<float>(kSize);
  marker.pose.orientation.w = 1;
  marker.controls = {axisControl("x", 1, 0, 0), axisControl("y", 0, 0, 1), axisControl("z", 0, 1, 0), ballControl()};
  return marker;
}

}  // namespace microinjection
