#pragma once

#include <yaml-cpp/yaml.h>

namespace microinjection {

/// A scene (YAML) with another size of the cell: the layers are scaled with the diameter (m), and the
/// outer one of two has the thickness (m) if that is a number. Throws ConfigError for a scene without
/// a diameter or layers, and for a thickness that leaves no inner layer.
YAML::Node withMeasuredSize(const YAML::Node& scene, double diameter, double zona_thickness);

/// Layers of a scene's cell; 1 for a cell with a diameter.
std::size_t layersOf(const YAML::Node& scene);

}  // namespace microinjection
