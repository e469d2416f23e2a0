#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "operation/display/surface_quantity.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// The colour scale as an upright bar in the x-z plane, facing -y; display units.
struct Legend {
  struct Label {
    Eigen::Vector3d position;
    std::string text;
  };
  TriangleSoup bar;
  std::vector<Label> labels;  ///< figures from below, then the title's lines
};

/// @param corner  lower left corner of the bar, display units
/// @param height  of the bar, display units
Legend colourLegend(const Eigen::Vector3d& corner, double height, const ColourScale& scale);

}  // namespace microinjection
