#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cell/model/converged_tongue.h"

namespace microinjection {

/// The command line of `aspirate`.
struct AspirateArguments {
  std::string scene;              ///< file
  std::vector<double> pressures;  ///< Pa, gauge; empty: the scene's own
  ConvergedTongueConfig config;
  bool tolerance_given = false;
  std::string csv = "-";  ///< file, or - for the standard output
};

/// Returns nothing after printing the help. Throws ConfigError, or an exception of boost::program_options, on bad
/// usage.
std::optional<AspirateArguments> parseAspirateArguments(int argc, char** argv);

}  // namespace microinjection
