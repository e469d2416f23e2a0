#pragma once

#include <optional>
#include <string>

#include "vision/measurement/vision_config.h"

namespace microinjection {

/// Command line of `measure_cell`.
struct MeasureCellArguments {
  std::string input;                               ///< image, folder or video
  VisionConfig vision = VisionConfig::standard();  ///< with the pixel size
  std::string scene;                               ///< file, from which `out` is written; empty: none
  std::string out;                                 ///< scene file to write; empty: none
  std::string overlay;                             ///< picture to write; empty: none
  std::string families;                            ///< folder; empty: none
};

/// Returns nothing after printing the help. Throws ConfigError on bad usage.
std::optional<MeasureCellArguments> parseMeasureCellArguments(int argc, char** argv);

}  // namespace microinjection
