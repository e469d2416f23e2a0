#pragma once

#include <optional>
#include <string>

#include "commands/prepare_family.h"

namespace microinjection {

/// Of the command `prepare`; its --help explains them.
struct PrepareArguments {
  std::string scene;
  std::string families;
  FamilyArguments family;
  int jobs = 1;
  int ray = -1;
  std::string at;  ///< coordinates of a family's member
  int member = -1;
  int axis = -1;
  int task = -1;
  int count = 1;
  bool gather = false;
  bool again = false;
};

/// Nothing after printing the help. Throws ConfigError that names the option.
std::optional<PrepareArguments> parsePrepareArguments(int argc, char** argv);

}  // namespace microinjection
