#pragma once

#include <string>

namespace microinjection {

/// The file of config/ that describes a node's private parameters; empty for a node without one.
std::string parameterText(const std::string& node);

}  // namespace microinjection
