#pragma once

#include <visualization_msgs/Marker.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "operation/display/cell_members.h"
#include "operation/display/force_arrow.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Identifies and places a marker in rviz. Its header's stamp stays 0: rviz uses the latest
/// transform.
struct MarkerName {
  std::string frame;  ///< under viz/
  std::string name;   ///< the marker's namespace
  int id = 0;
};

/// Conversions of the display room's geometry (display units) to rviz's markers.
visualization_msgs::Marker triangleMarker(const MarkerName& name, const TriangleSoup& soup, const Colour& colour);
visualization_msgs::Marker lineMarker(const MarkerName& name, const LineList& lines, double width,
                                      const Colour& colour);
visualization_msgs::Marker lineMarker(const MarkerName& name, const ColouredLines& lines, double width);
visualization_msgs::Marker sphereMarker(const MarkerName& name, const std::vector<Eigen::Vector3d>& points,
                                        double diameter, const Colour& colour);
visualization_msgs::Marker arrowMarker(const MarkerName& name, const Arrow& arrow, const Colour& colour);
visualization_msgs::Marker textMarker(const MarkerName& name, const Eigen::Vector3d& position, const std::string& text,
                                      double height, const Colour& colour);
/// Removes a marker.
visualization_msgs::Marker noMarker(const MarkerName& name);

}  // namespace microinjection
