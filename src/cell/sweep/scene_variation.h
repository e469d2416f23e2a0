#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

namespace microinjection {

/// A copy of a scene's map in which each key (path with '/'; a number is the place in a list, from 0)
/// has the value of the same place. An alias of a changed key keeps its value. Missing maps are made,
/// so that keys with a default can be set. Throws ConfigError when a path runs through a scalar or
/// past the end of a list, or when the scene is deeper than 100 maps and lists.
YAML::Node varied(const YAML::Node& scene, const std::vector<std::string>& keys,
                  const std::vector<std::string>& values);

}  // namespace microinjection
