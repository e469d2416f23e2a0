#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "vision/measurement/cell_measurement.h"

namespace microinjection {

/// A scene (YAML) with another size of the cell: the layers are scaled with the diameter (m), and the
/// outer one of two has the thickness (m) if that is a number. Throws ConfigError for a scene without
/// a diameter or layers, and for a thickness that leaves no inner layer.
YAML::Node withMeasuredSize(const YAML::Node& scene, double diameter, double zona_thickness);
/// Throws also for a scene with a zona when none was measured, see requireSeenZona().
YAML::Node withMeasuredSize(const YAML::Node& scene, const CellMeasurement& cell);

/// Whether a scene of two layers meets a measurement without a zona: an image in which the zona was missed says nothing
/// about its thickness.
bool hasUnseenZona(const YAML::Node& scene, const CellMeasurement& cell);
constexpr char kUnseenZona[] =
    "the scene has a zona, and none was found in the image: its thickness would be invented. Take a scene of one "
    "layer, "
    "or an image that shows the zona";
/// Throws ConfigError where hasUnseenZona().
void requireSeenZona(const YAML::Node& scene, const CellMeasurement& cell);

/// Text of a scene file, with what was measured and the file that it was written from.
std::string measuredSceneText(const YAML::Node& scene, const std::string& measured, const std::string& from);

/// Layers of a scene's cell; 1 for a cell with a diameter.
std::size_t layersOf(const YAML::Node& scene);

}  // namespace microinjection
