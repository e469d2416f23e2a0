#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "vision/measurement/cell_measurement.h"

namespace microinjection {

/// A scene (YAML) with another size of the cell: the layers are scaled with the diameter (m), and the
/// outer one of two has the thickness (m) if that is a number. Throws ConfigError for a scene without
/// a diameter or layers, and for a thickness that leaves no inner layer.
YAML::Node withMeasuredSize(const YAML::Node& scene, double diameter, double zona_thickness);
YAML::Node withMeasuredSize(const YAML::Node& scene, const CellMeasurement& cell);

/// Text of a scene file, with what was measured and the file that it was written from.
std::string measuredSceneText(const YAML::Node& scene, const std::string& measured, const std::string& from);

/// Layers of a scene's cell; 1 for a cell with a diameter.
std::size_t layersOf(const YAML::Node& scene);

}  // namespace microinjection
