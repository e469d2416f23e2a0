#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "cell/model/scene.h"

namespace microinjection {

/// Throws ConfigError that names every value of the scene that no cell or needle has, as a length in um would be.
void checkPlausible(const Scene& scene);

/// As parseScene for a scene of radius 1 and modulus 1, to which no plausible range applies.
Scene parseDimensionlessScene(const YAML::Node& node, const std::string& origin);

}  // namespace microinjection
