#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "operation/display/legend.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Where the outermost layer is expected to fail.
struct PunctureDepth {
  double depth = 0, low = 0, high = 0;  ///< m, past the contact: median and interval of 95 %
  double force = 0;                     ///< N, median
  bool beyond = false;                  ///< deeper than the model reaches: `low` is all that is known
};

/// An upright scale of depth beside the cell, downwards: where the needle is, and where the puncture
/// is expected. Display units.
struct DepthGauge {
  LineList scale;
  LineList interval;                      ///< of the expected depth
  std::vector<Eigen::Vector3d> expected;  ///< its median
  std::vector<Eigen::Vector3d> present;   ///< the needle's depth; empty when it is not known
  std::vector<Legend::Label> labels;      ///< title, and figures in micrometres
};

/// @param top  upper end, depth 0, display units
/// @param indentation  m, of the needle
DepthGauge depthGauge(const Eigen::Vector3d& top, double height, const PunctureDepth& puncture,
                      const std::optional<double>& indentation);

}  // namespace microinjection
