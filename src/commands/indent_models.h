#pragma once

#include <vector>

#include "cell/model/scene.h"
#include "commands/indent_arguments.h"

namespace microinjection {

/// Forces of the scene at the depths of the arguments, by the model that they name. Reports its progress on
/// the error output. Throws ConfigError when the scene does not have that model.
std::vector<ForcePoint> solveIndentation(const Scene& scene, const IndentArguments& arguments);

}  // namespace microinjection
