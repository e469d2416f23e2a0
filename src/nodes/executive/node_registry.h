#pragma once

#include <string>

#include "nodes/executive/executive.h"

namespace microinjection {

/// Makes nodes of a program's kind, such as cell_simulator. @throws ConfigError when no node that runs on
/// any bus is called so
NodeFactory nodeFactory(const std::string& program);

}  // namespace microinjection
