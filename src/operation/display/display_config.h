#pragma once

#include <string>

#include "base/config_reader.h"
#include "operation/display/display_scale.h"
#include "operation/display/pipettes.h"

namespace microinjection {

struct DisplayConfig {
  double rate = 30;                     ///< Hz of wall time, of the markers, at most 60
  bool edges = true;                    ///< draw the edges of the cell's mesh, where it is coarse
  std::string colour = "displacement";  ///< of the cell's surface at the start, one of surfaceQuantities()
  double colour_range = 0;              ///< m, displacement at the end of the colour scale; 0: the largest so far
  double stress_range = 0;              ///< Pa, stress or pressure there; 0: the largest so far
  double enlargement = kDisplayScale;   ///< m in rviz per m
  bool section = false;                 ///< the cell is cut open at the start
  double trail = 10;                    ///< s, of the tip's way that is shown; 0: none
  double force_scale = 5;               ///< m/N, length of a force's arrow in the scene, before the enlargement
  DrawnInjectionPipette injection_pipette;
  DrawnHoldingPipette holding_pipette;

  static DisplayConfig read(ConfigReader& reader);
};

}  // namespace microinjection
