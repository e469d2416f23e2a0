#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cell/model/scene.h"
#include "commands/indent_arguments.h"

namespace microinjection {

/// Takes a line of progress.
using Report = std::function<void(const std::string& line)>;

/// Prints a line on the error output, as `indent` does.
void printProgress(const std::string& line);

/// Forces of the scene at the depths of the arguments, by the model that they name. Throws
/// ConfigError as IndentArguments::requireFit does.
std::vector<ForcePoint> solveIndentation(const Scene& scene, const IndentArguments& arguments,
                                         const Report& report = printProgress);

}  // namespace microinjection
