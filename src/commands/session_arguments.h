#pragma once

#include <optional>
#include <string>
#include <vector>

namespace microinjection {

struct SessionArguments {
  std::string session = "default";    ///< a file, or a name of config/sessions
  std::vector<std::string> keys;      ///< KEY:=VALUE
  std::string launch, view;           ///< files to write; empty: none
  bool print = false, nodes = false;  ///< prints the session, its nodes
  std::vector<std::string> only;      ///< nodes; empty: all
};

/// Nothing after printing the help. Ignores the arguments that roslaunch adds. Throws ConfigError.
std::optional<SessionArguments> parseSessionArguments(int argc, char** argv);

}  // namespace microinjection
