#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cell/identification/force_curve.h"
#include "cell/identification/formula_law.h"
#include "cell/identification/identification.h"
#include "cell/identification/point_identification.h"
#include "vision/measurement/vision_config.h"

namespace microinjection {

/// Command line of `identify`.
struct IdentifyArguments {
  std::string record;  ///< file; empty with a point and with tongues
  std::string tongue;  ///< file of tongues by suction, alone or beside the record of the same cell; empty: none
  std::optional<VisionConfig> vision;  ///< with the pixel size, of the images that `tongue` names; none: it has lengths
  std::optional<MeasuredPoint> point;
  std::string scene;                ///< file; empty: none
  std::vector<std::string> models;  ///< of the list in the help
  std::vector<std::string> free;    ///< ratios of a family
  FormulaGeometry geometry;         ///< given by options; 0 or, for Poisson's ratio, -1: that of the scene
  std::string families;             ///< folder
  ForceCurveConfig curve;
  IdentificationConfig identification;
  std::string out;            ///< scene file; empty: none
  std::string residuals;      ///< CSV file; empty: none
  std::string csv;            ///< same, of what was found
  std::string free_material;  ///< of freeMaterialParameters(); empty: none
};

/// Returns nothing after printing the help. Throws ConfigError, or an exception of
/// boost::program_options, on bad usage.
std::optional<IdentifyArguments> parseIdentifyArguments(int argc, char** argv);

}  // namespace microinjection
