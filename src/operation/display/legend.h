#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "operation/display/triangle_soup.h"

namespace microinjection {

/// The colour scale as an upright bar in the x-z plane, facing -y; display units.
struct Legend {
  struct Label {
    Eigen::Vector3d position;
    std::string text;
  };
  TriangleSoup bar;
  std::vector<Label> labels;  ///< title and figures in micrometres
};

/// @param corner  lower left corner of the bar, display units
/// @param height  of the bar, display units
/// @param range   m, displacement at the upper end
Legend displacementLegend(const Eigen::Vector3d& corner, double height, double range);

}  // namespace microinjection
