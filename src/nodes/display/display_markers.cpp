#include "nodes/display/display_markers.h"

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>

#include <algorithm>

#include "nodes/runtime/conversions.h"

namespace microinjection {
namespace {

using visualization_msgs::Marker;

constexpr auto toPoint = toMessage<geometry_msgs::Point>;

std_msgs::ColorRGBA toColour(const Colour& colour) {
  std_msgs::ColorRGBA message;
  message.r = colour.r;
  message.g = colour.g;
  message.b = colour.b;
  message.a = colour.a;
  return message;
}

std::vector<geometry_msgs::Point> toPoints(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<geometry_msgs::Point> points(vectors.size());
  std::transform(vectors.begin(), vectors.end(), points.begin(), toPoint);
  return points;
}

Marker makeMarker(const MarkerName& name, int type, const Colour& colour) {
  Marker marker;
  marker.header.frame_id = name.frame;
  marker.ns = name.name;
  marker.id = name.id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.frame_locked = true;
  marker.color = toColour(colour);
  return marker;
}

/// Without points it removes the marker, since rviz reports an error for an empty list.
Marker listMarker(const MarkerName& name, int type, const std::vector<Eigen::Vector3d>& points, double size,
                  const Colour& colour) {
  if (points.empty()) return noMarker(name);
  Marker marker = makeMarker(name, type, colour);
  marker.points = toPoints(points);
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  return marker;
}

}  // namespace

Marker triangleMarker(const MarkerName& name, const TriangleSoup& soup, const Colour& colour) {
  Marker marker = listMarker(name, Marker::TRIANGLE_LIST, soup.points, 1, colour);
  marker.colors.reserve(soup.colours.size());
  for (const Colour& point_colour : soup.colours) marker.colors.push_back(toColour(point_colour));
  return marker;
}

Marker lineMarker(const MarkerName& name, const LineList& lines, double width, const Colour& colour) {
  return listMarker(name, Marker::LINE_LIST, lines, width, colour);
}

Marker lineMarker(const MarkerName& name, const ColouredLines& lines, double width) {
  Marker marker = lineMarker(name, lines.lines, width, {1, 1, 1, 1});
  for (const Colour& colour : lines.colours) marker.colors.push_back(toColour(colour));
  return marker;
}

Marker sphereMarker(const MarkerName& name, const std::vector<Eigen::Vector3d>& points, double diameter,
                    const Colour& colour) {
  return listMarker(name, Marker::SPHERE_LIST, points, diameter, colour);
}

Marker arrowMarker(const MarkerName& name, const Arrow& arrow, const Colour& colour) {
  Marker marker = makeMarker(name, Marker::ARROW, colour);
  marker.points = {toPoint(arrow.tail), toPoint(arrow.head)};
  marker.scale.x = arrow.shaft_diameter;
  marker.scale.y = arrow.head_diameter;
  marker.scale.z = arrow.head_length;
  return marker;
}

Marker textMarker(const MarkerName& name, const Eigen::Vector3d& position, const std::string& text, double height,
                  const Colour& colour) {
  Marker marker = makeMarker(name, Marker::TEXT_VIEW_FACING, colour);
  marker.pose.position = toPoint(position);
  marker.scale.z = height;
  marker.text = text;
  return marker;
}

Marker noMarker(const MarkerName& name) {
  Marker marker = makeMarker(name, Marker::CUBE, {});
  marker.action = Marker::DELETE;
  return marker;
}

}  // namespace microinjection
