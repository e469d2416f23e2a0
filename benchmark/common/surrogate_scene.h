#pragma once

#include <string>

#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// What `prepare` left of a scene in the cache; runs it first, which takes minutes, where there is
/// nothing. `scene_file`: where the scene was read. @throws std::runtime_error when that fails.
SurrogateData surrogateScene(const Scene& scene, const std::string& scene_file);

}  // namespace microinjection
