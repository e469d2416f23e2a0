#pragma once

#include <string>

namespace microinjection {

/// Of the command `sweep`; its --help explains them.
struct SweepArguments {
  std::string file, out;
  bool list = false, gather = false;
  long task = -1;  ///< the first task to do; -1: all that are missing
  int count = 1;
  int jobs = 1;
  bool worker = false;
  bool show_help = false;
  std::string help;  ///< of the command, with its options
};

/// Throws ConfigError, or a boost::program_options error, that names the option.
SweepArguments parseSweepArguments(int argc, char** argv);

}  // namespace microinjection
