#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "cell/model/converged_force.h"

namespace microinjection {

/// What the command line of `indent` asks for.
struct IndentArguments {
  std::string scene;  ///< file
  Indenting indenting;
  bool live = false;      ///< the live session's mesh of P1 tetrahedra instead of a converged solution
  bool membrane = false;  ///< the scene's biomembrane instead
  ConvergedForceConfig converged;
  bool tolerance_given = false;
  std::vector<std::string> converged_options;  ///< that were given and mean something to a converged solution only
  std::string csv = "-";                       ///< file, or - for the standard output
};

/// Empty when the help was asked for, and printed. Throws ConfigError, or what boost::program_options throws, on bad
/// usage.
std::optional<IndentArguments> parseIndentArguments(int argc, char** argv);

}  // namespace microinjection
